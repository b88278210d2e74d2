// SPDX-License-Identifier: MIT
// Settings of a live run as viewers list, read and change them, and the start of another run where a setting
// needs one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::live {

/// Run that viewers chose during another one.
struct ChosenRun {
  scenario::Scenario scenario;
  std::vector<telemetry::Change> choices{};  ///< choices of viewers, each key once, in order
};

/// Run that is ready to begin: everything that takes time is made.
struct BuiltRun {
  std::unique_ptr<run::ClosedLoop> loop;
  protocol::Run description;                               ///< description for viewers
  std::unique_ptr<const recording::RecordedRun> recorded;  ///< description for the recording
  std::vector<telemetry::Change> choices{};                ///< choices of viewers that led to it
};

/// Describes a run for its viewers.
using Describe = std::function<protocol::Run(const run::ClosedLoop&)>;
/// Builds a chosen run: reads track and car, makes the controller, plans its lap. Fails as
/// ClosedLoop::create().
[[nodiscard]] Result<std::unique_ptr<BuiltRun>> build_run(ChosenRun run, const Describe& describe);

/// Options of LiveSettings.
struct LiveSettingsOptions {
  scenario::Scenario scenario;  ///< scenario of the current run
  /// Whether this program simulates the car: offers settings of the world, pace and manual driving as well.
  /// Otherwise offers the controller's settings only.
  bool has_world = true;
  /// Switches of faults, "fault.…".
  std::vector<protocol::Control> faults{};
  /// Begins to build another run, in place of one in construction. Does not wait. Empty: settings that need
  /// another run are not offered.
  std::function<void(ChosenRun)> build{};
  /// Result of the newest build; none during a build. A built run is handed over to the control thread before
  /// this returns; the thread takes it at the change that `starts_anew`.
  std::function<std::optional<Result<void>>()> built{};
  /// Gets the description of the current build: "track = oval"; empty: none.
  std::function<void(const std::string&)> on_building{};
  /// Gets notices for the operator, not for viewers: why a viewer's choice failed, if the reason names files.
  std::function<void(std::string_view)> say{};
  /// Called after each accepted change of the current scenario, and when another run has begun.
  std::function<void(const scenario::Scenario&)> on_accepted{};
};

/// Settings of a running run, for viewers to read and set: every setting of the schema under its own key,
/// "run.pace", "manual.is_on", "manual.steer", "manual.throttle" and the faults (docs/viewer.md).
///
/// A value is read and checked on the network thread, and then waits in a queue until the control thread
/// applies it between two cycles. get() and list() show the last accepted value. That value holds from the
/// next control step on, or, if it needs another run, once that run is built. Until then the current run
/// continues, changes count for both runs, and another choice replaces the one before. All member functions
/// except tell() are called on the network thread.
///
/// Viewers are strangers (docs/reference/security.md). They choose presets, cars and tracks of the library by
/// name, and no files except those that the run was started with; no sentence for viewers quotes a file.
/// Settings of the guard and of the car's model, and so the limits of commands, are shown but cannot be set
/// (protocol::is_fixed): every run has the guard that the program was started with.
class LiveSettings final : public protocol::foxglove::ParameterStore {
 public:
  /// `requests` is emptied by the control thread, and outlives this.
  LiveSettings(LiveSettingsOptions options, run::SettingQueue& requests);

  [[nodiscard]] std::vector<protocol::foxglove::Parameter> list() const override;
  [[nodiscard]] std::optional<protocol::foxglove::Parameter> get(std::string_view name) const override;
  /// Sets a value. Fails with a sentence for unknown names, wrong types, values out of range, settings that
  /// exclude each other, and when too many changes wait.
  [[nodiscard]] Result<void> set(const protocol::foxglove::Parameter& parameter) override;

  /// Reports a change that was applied, or happened by itself; called on the control thread. Never waits: if
  /// applied() is not called for long, changes are lost for viewers.
  void tell(const telemetry::Change& change) noexcept { static_cast<void>(announced_.push(change)); }
  [[nodiscard]] std::vector<telemetry::Change> applied() override;
  [[nodiscard]] std::vector<protocol::foxglove::Parameter> news() override;
  /// Hands a built run over, if there is one and the queue has room.
  void update() override;
  [[nodiscard]] std::vector<std::string> complaints() override;

  /// Text for GET /schema.json: "default" is the value by preset and car, "start" the value at the start of
  /// the run.
  [[nodiscard]] std::string schema_json() const;
  /// Number that changes when schema_json() may have changed.
  [[nodiscard]] std::uint64_t schema_version() const { return runs_; }
  /// Text for GET /preset.yaml: the current settings as a preset.
  [[nodiscard]] std::string preset_yaml() const;
  /// Scenario of the current run, or of the one that was handed over.
  [[nodiscard]] const scenario::Scenario& scenario() const { return scenario_; }

 private:
  /// Run in construction.
  struct Building {
    ChosenRun run;                                           ///< the run, with changes since its choice
    scenario::Scenario base{};                               ///< scenario of its preset with its car
    std::map<std::string, run::Setting, std::less<>> later;  ///< live changes since its choice, by key
  };

  /// Scenario whose values viewers see: that of the run in construction, else the current one.
  [[nodiscard]] const scenario::Scenario& shown_scenario() const {
    return building_ ? building_->run.scenario : scenario_;
  }
  /// Whether viewers see a setting in this kind of run.
  [[nodiscard]] bool is_offered(const protocol::Parameter& row) const;
  /// Sets pace, manual driving or a fault.
  [[nodiscard]] Result<void> set_control(const protocol::Control& control, const protocol::Value& value);
  /// Sets a setting of the schema: of the current run and of the one in construction, or by start_anew(). A
  /// change that is valid in the latter only waits for it.
  [[nodiscard]] Result<void> set_row(const protocol::Parameter& row, const protocol::Value& value);
  /// Begins to build another run by a choice that leads to `changed`.
  [[nodiscard]] Result<void> start_anew(telemetry::Change choice, scenario::Scenario changed);
  /// Accepts a name of the library, or the value at the start of the program, which may be a file.
  [[nodiscard]] Result<void> check_choice(std::string_view key, const std::string& value) const;
  /// Version of an error for viewers: texts that quote files are for the operator only.
  [[nodiscard]] tl::unexpected<Error> hide(std::string_view what, const Error& error) const;
  /// Hands over a built run as the next one, followed by later changes.
  void hand_over(Building building);
  /// Updates start_ for a run that begins.
  void update_start(const Building& building);
  /// Sends pace and manual driving again: a new run knows neither. Faults end with the old run.
  void hand_over_controls();
  /// Queues a setting for the control thread. Fails if the queue is full.
  [[nodiscard]] Result<void> send(const run::Setting& setting);

  LiveSettingsOptions options_;
  run::SettingQueue& requests_;              ///< settings for the control thread
  run::ChangeQueue announced_;               ///< changes by tell()
  scenario::Scenario scenario_;              ///< scenario of the current run
  scenario::Scenario base_;                  ///< scenario of its preset with its car
  scenario::Scenario start_;                 ///< scenario at its start
  std::optional<Building> building_;         ///< run in construction
  std::vector<protocol::Control> controls_;  ///< pace, manual driving, faults
  std::map<std::string, protocol::Value, std::less<>> control_values_;  ///< their last accepted values
  std::vector<protocol::foxglove::Parameter> shown_;                    ///< parameters by the last news()
  bool has_news_ = false;                                               ///< parameters may have changed since
  std::uint64_t runs_ = 0;                                              ///< runs handed over
  std::vector<std::string> complaints_;                                 ///< sentences for complaints()
};

}  // namespace chicane::live
