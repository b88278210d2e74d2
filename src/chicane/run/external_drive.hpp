// SPDX-License-Identifier: MIT
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
  /// The road, where it is known: the car is judged by the positions that are measured. Outlives the drive;
  /// null: laps are timed all the same.
  const road::Track* track = nullptr;
  std::shared_ptr<const road::RacingRoad> lap{};  ///< planned, of a controller that races (run/racing.hpp)
  std::chrono::nanoseconds step_budget{0};        ///< deadline of a control step; 0 = none
  /// Gap between cycles, in addition to twice the delay, after which learned values are dropped.
  std::chrono::nanoseconds forget_after = std::chrono::milliseconds{500};
  PlantClockOptions clock{};                              ///< options of the run's clock
  std::string_view remedy = telemetry::kSimulatorRemedy;  ///< SituationTerms::remedy
};

/// Callbacks of an ExternalDrive; empty functions are not called.
struct ExternalDriveHooks {
  SettingQueue* settings = nullptr;  ///< changes to apply before the next cycle; outlives the drive
  std::function<void(const telemetry::Change&)> on_change{};     ///< one was taken up
  std::function<void(const telemetry::Frame&)> on_frame{};       ///< called after each cycle
  std::function<void(const telemetry::CompletedLap&)> on_lap{};  ///< a lap was completed
  /// Reports that the car drives on another road than ExternalDriveOptions::track, with the largest distance
  /// from it [m]. Once.
  std::function<void(double)> on_other_road{};
  std::function<void(std::string_view)> on_clock{};  ///< time is counted otherwise: a sentence for people
};

/// The control cycles of a car that is not simulated here, whatever dialect it speaks: the cycle, the account
/// of the run, settings and planned laps. For each measurement: step(), send the command, finish(). One
/// thread.
class ExternalDrive {
 public:
  using Clock = std::chrono::steady_clock;

  /// Measurement of the car at a moment, or its absence.
  struct Sighting {
    Clock::time_point received{};                  ///< arrival of the measurement
    std::optional<model::Measurement> measured{};  ///< none: unusable, or it did not come
    double delay = 0.0;        ///< expected until the command acts, by the wall's clock [s]
    double usual_delay = 0.0;  ///< delay expected one cycle earlier [s]
  };

  /// Pre: `controller` is not null. `hooks` outlive this.
  ExternalDrive(ExternalDriveOptions options, std::unique_ptr<controller::Controller> controller,
                const ExternalDriveHooks& hooks);

  /// Begins with another car, or the same one after an absence: learned values are dropped.
  void begin();
  /// Time between the last two cycles, if the current one is `received`; none at the start [s].
  [[nodiscard]] std::optional<double> gap(Clock::time_point received) const;
  /// A person drives, or the car was put elsewhere: the next measurement is the first of a run.
  void begin_anew();

  /// One cycle: the command is the frame's.
  const telemetry::Frame& step(const Sighting& sighting);
  /// Counts the cycle and publishes it; call it after the command was sent.
  void finish();

  [[nodiscard]] const telemetry::Frame& frame() const { return frame_; }
  /// The stop at hand with the last command.
  [[nodiscard]] const safety::StopPlan& stop() const { return cycle_.stop(); }
  /// Time of the run [s], since this was made, by PlantClock.
  [[nodiscard]] double time(Clock::time_point at) const { return clock_.at(at); }
  [[nodiscard]] telemetry::RunSummary summary() const { return roadside_.summary(); }

 private:
  void watch_gap(double gap, double delay);
  void count_time(const Sighting& sighting);
  void check_road(const Sighting& sighting);
  void take_up_changes(double time);

  ExternalDriveOptions options_;
  const ExternalDriveHooks& hooks_;
  scenario::Scenario scenario_;
  ControlCycle cycle_;
  LapPlanner planner_{LapPlanner::Clock::kReal};
  Roadside roadside_;
  PlantClock clock_;
  std::optional<Clock::time_point> last_received_;
  std::optional<double> last_time_;  ///< time of the last cycle since the run began [s]
  bool begins_again_ = false;
  bool is_other_road_ = false;  ///< differs from the configured road
  model::Command last_sent_;
  model::Command acting_;  ///< acts between the last two measurements, until the next command does
  telemetry::Frame frame_;
};

}  // namespace chicane::run
