// SPDX-License-Identifier: MIT
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

/// A run that was chosen during another one.
struct ChosenRun {
  scenario::Scenario scenario;
  std::vector<telemetry::Change> choices{};  ///< choices of viewers, each key once, in order
};

/// A run that may begin, with all that takes time to make.
struct BuiltRun {
  std::unique_ptr<run::ClosedLoop> loop;
  protocol::Run description;                               ///< description for viewers
  std::unique_ptr<const recording::RecordedRun> recorded;  ///< description for the recording
  std::vector<telemetry::Change> choices{};
};

/// Describes a run for its viewers.
using Describe = std::function<protocol::Run(const run::ClosedLoop&)>;
/// Makes the run that was chosen: track, car and controller are read and planned. Fails as
/// ClosedLoop::create() does.
[[nodiscard]] Result<std::unique_ptr<BuiltRun>> build_run(ChosenRun run, const Describe& describe);

struct LiveSettingsOptions {
  scenario::Scenario scenario;  ///< scenario of the current run
  /// Whether we simulate: offers what concerns the world, its pace and manual driving, too. Otherwise only
  /// the controller.
  bool has_world = true;
  /// Faults to switch, in addition to the rest: "fault.…".
  std::vector<protocol::Control> faults{};
  /// Begins to build another run in parallel, replacing one in construction. Does not wait. Null: settings
  /// that need another run are not offered.
  std::function<void(ChosenRun)> build{};
  /// Result of the newest build; none during a build. A built run is handed over to the control thread before
  /// this returns; the thread takes it at the change that `starts_anew`.
  std::function<std::optional<Result<void>>()> built{};
  /// Description of the current build: "track = oval"; empty: none.
  std::function<void(const std::string&)> on_building{};
  /// Notice for the operator, not for viewers: why a viewer's choice failed, if the reason names files.
  std::function<void(std::string_view)> say{};
  /// Called after each accepted change of the current scenario, and when another run has begun.
  std::function<void(const scenario::Scenario&)> on_accepted{};
};

/// Settings of a running run, for viewers to read and set: every setting of the schema under its own key,
/// "run.pace", "manual.is_on", "manual.steer", "manual.throttle" and the faults (docs/viewer.md).
///
/// A value is read and checked here, on the network thread, and then waits as data in a queue until the
/// control thread applies it between two cycles. get() and list() show the last accepted value: it holds from
/// the next control step on, or, if it restarts the run, once the other run has been built. Until then the
/// old run continues, changes count for both, and another choice replaces the one before. All member
/// functions but tell() are the network thread's.
///
/// Viewers are strangers. They choose presets, cars and tracks of the library by name, and no file but those
/// the run was started with; no sentence for them quotes a file. Settings of the guard and of the
/// car's model, and so the limits of commands, are shown and refused (protocol::is_fixed): every run that
/// viewers choose has the guard that the program was started with, and its model belongs to the car
/// (docs/reference/security.md).
class LiveSettings final : public protocol::foxglove::ParameterStore {
 public:
  /// `requests` is drained by the control thread and outlives this.
  LiveSettings(LiveSettingsOptions options, run::SettingQueue& requests);

  [[nodiscard]] std::vector<protocol::foxglove::Parameter> list() const override;
  [[nodiscard]] std::optional<protocol::foxglove::Parameter> get(std::string_view name) const override;
  /// Fails with a sentence for unknown names, wrong types, values out of range, settings that exclude each
  /// other, and when too many changes wait.
  [[nodiscard]] Result<void> set(const protocol::foxglove::Parameter& parameter) override;

  /// Reports from the control thread that a change was applied, or happened by itself. Never waits; viewers
  /// miss it if update() has not been called for long.
  void tell(const telemetry::Change& change) noexcept { static_cast<void>(announced_.push(change)); }
  [[nodiscard]] std::vector<telemetry::Change> applied() override;
  [[nodiscard]] std::vector<protocol::foxglove::Parameter> news() override;
  /// Hands the run that has been built over, where there is one and the queue has room.
  void update() override;
  [[nodiscard]] std::vector<std::string> complaints() override;

  /// Text for GET /schema.json; "default" is the chosen preset's value with the chosen car, "start" the value
  /// at the run's start.
  [[nodiscard]] std::string schema_json() const;
  /// Number that changes when schema_json() may have changed.
  [[nodiscard]] std::uint64_t schema_version() const { return runs_; }
  /// GET /preset.yaml: what runs, as a preset.
  [[nodiscard]] std::string preset_yaml() const;
  /// Scenario that runs, or has been handed over to run.
  [[nodiscard]] const scenario::Scenario& scenario() const { return scenario_; }

 private:
  /// Another run in construction.
  struct Building {
    ChosenRun run;                                           ///< changes since it was begun included
    scenario::Scenario base{};                               ///< scenario of its preset with its car
    std::map<std::string, run::Setting, std::less<>> later;  ///< live changes since then, by key
  };

  [[nodiscard]] const scenario::Scenario& shown_scenario() const {
    return building_ ? building_->run.scenario : scenario_;
  }
  [[nodiscard]] bool is_offered(const protocol::Parameter& row) const;
  [[nodiscard]] Result<void> set_control(const protocol::Control& control, const protocol::Value& value);
  [[nodiscard]] Result<void> set_row(const protocol::Parameter& row, const protocol::Value& value);
  [[nodiscard]] Result<void> change_live(const run::Setting& setting, scenario::Scenario changed);
  [[nodiscard]] Result<void> start_anew(telemetry::Change choice, scenario::Scenario changed);
  [[nodiscard]] Result<void> check_choice(std::string_view key, const std::string& value) const;
  [[nodiscard]] tl::unexpected<Error> hide(std::string_view what, const Error& error) const;
  void hand_over(Building building);
  void begin_with(const Building& building);
  void hand_over_controls();
  [[nodiscard]] Result<void> send(const run::Setting& setting);

  LiveSettingsOptions options_;
  run::SettingQueue& requests_;
  run::ChangeQueue announced_;
  scenario::Scenario scenario_;
  scenario::Scenario base_;   ///< scenario of its preset with its car
  scenario::Scenario start_;  ///< scenario at the start of the run
  std::optional<Building> building_;
  std::vector<protocol::Control> controls_;
  std::map<std::string, protocol::Value, std::less<>> control_values_;
  std::vector<protocol::foxglove::Parameter> shown_;  ///< parameters that news() reported last
  bool has_news_ = false;
  std::uint64_t runs_ = 0;  ///< count of runs handed over
  std::vector<std::string> complaints_;
};

}  // namespace chicane::live
