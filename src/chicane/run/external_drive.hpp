// SPDX-License-Identifier: MIT
// Control cycles of a car that another program simulates, or of a real one, in whatever protocol it speaks.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "chicane/controller/controller.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/account.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/plant_clock.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/safety/stop_player.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Options of an ExternalDrive.
struct ExternalDriveOptions {
  scenario::Scenario scenario;
  /// Road on which the car is judged by its measured positions; outlives the drive. Null: the road is
  /// unknown, and laps are timed without it.
  const road::Track* track = nullptr;
  std::shared_ptr<const road::RacingRoad> lap{};  ///< planned lap to race by (run/racing.hpp); null: none
  std::chrono::nanoseconds step_budget{0};        ///< deadline of a control step; 0 = none
  /// Gap between cycles, in addition to twice the delay, after which learned values are dropped. Chosen: a
  /// car may have been stopped or put elsewhere in the meantime.
  std::chrono::nanoseconds forget_after = std::chrono::milliseconds{500};
  PlantClockOptions clock{};                              ///< options of the run's clock
  std::string_view remedy = telemetry::kSimulatorRemedy;  ///< SituationTerms::remedy
};

/// Callbacks of an ExternalDrive; empty functions are not called.
struct ExternalDriveHooks {
  SettingQueue* settings = nullptr;  ///< changes to apply before the next cycle; outlives the drive
  std::function<void(const telemetry::Change&)> on_change{};     ///< called after a change was applied
  std::function<void(const telemetry::Frame&)> on_frame{};       ///< called after each cycle
  std::function<void(const telemetry::CompletedLap&)> on_lap{};  ///< called after each lap
  /// Called once, when the car drives on another road than ExternalDriveOptions::track, with the largest
  /// distance from it [m].
  std::function<void(double)> on_other_road{};
  std::function<void(std::string_view)> on_clock{};  ///< called with a sentence when the run's clock changes
};

/// Control cycles of a car that is not simulated here, in any protocol, with the account of the run, settings
/// and planned laps. For each measurement call step(), send the command, call finish(). One thread.
class ExternalDrive {
 public:
  using Clock = std::chrono::steady_clock;

  /// Measurement of the car at a moment, or its absence.
  struct Sighting {
    Clock::time_point received{};                  ///< arrival of the measurement
    std::optional<model::Measurement> measured{};  ///< none: missing or unusable
    double delay = 0.0;        ///< expected time until the command acts, by the machine's clock [s]
    double usual_delay = 0.0;  ///< delay expected one cycle earlier [s]
  };

  /// Pre: `controller` is not null. `hooks` outlive this.
  ExternalDrive(ExternalDriveOptions options, std::unique_ptr<controller::Controller> controller,
                const ExternalDriveHooks& hooks);

  /// Begins with another car, or the same car after an absence: drops learned values.
  void begin();
  /// Time from the last measurement to one that arrived at `received` [s]; none before the first.
  [[nodiscard]] std::optional<double> gap(Clock::time_point received) const;
  /// Restarts the cycle because a person drives or the car was put elsewhere: the next measurement is the
  /// first of a run.
  void begin_anew() { begin_on_link(cycle_.longest()); }

  /// One cycle. The returned frame holds the command to send.
  const telemetry::Frame& step(const Sighting& sighting);
  /// Counts the cycle and publishes it; call it after the command was sent.
  void finish();

  [[nodiscard]] const telemetry::Frame& frame() const { return frame_; }
  /// Stop plan that belongs to the last command.
  [[nodiscard]] const safety::StopPlan& stop() const { return cycle_.stop(); }
  /// Time of the run at `at` [s], from the construction of this object on, by PlantClock.
  [[nodiscard]] double time(Clock::time_point at) const { return clock_.at(at); }
  [[nodiscard]] telemetry::RunSummary summary() const { return account_.summary(); }

 private:
  /// Restarts cycle and account; `longest`: ControlCycle::begin() [s].
  void begin_on_link(double longest);
  /// Restarts after a long `gap` between two measurements [s]; `delay`: expected delay [s].
  void watch_gap(double gap, double delay);
  /// Advances the run's clock to a measurement. True: the clock was replaced, so that the plan is invalid.
  [[nodiscard]] bool count_time(const Sighting& sighting);
  /// Drops a configured track that does not match the visible waypoints.
  void check_road(const Sighting& sighting);
  /// Applies waiting changes at the run's `time` [s].
  void take_up_changes(double time);

  ExternalDriveOptions options_;
  const ExternalDriveHooks& hooks_;
  scenario::Scenario scenario_;
  ControlCycle cycle_;
  LapPlanner planner_{LapPlanner::Clock::kReal};
  Roadside account_;
  PlantClock clock_;                                ///< time of the run
  std::optional<Clock::time_point> last_received_;  ///< arrival of the last measurement; none: a run begins
  std::optional<double> last_time_;                 ///< time of the last cycle in this run [s]
  bool begins_again_ = false;                       ///< the next measurement restarts the cycle a second time
  bool has_clock_news_ = false;                     ///< a replaced clock is not reported yet
  bool is_other_road_ = false;  ///< the car drives on another road than the configured one
  model::Command last_sent_;    ///< command of the last cycle
  model::Command acting_;       ///< command that acted between the last two measurements
  telemetry::Frame frame_;
};

}  // namespace chicane::run
