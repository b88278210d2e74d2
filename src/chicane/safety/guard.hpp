// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>

#include "chicane/base/deadline.hpp"
#include "chicane/base/owned.hpp"
#include "chicane/controller/command_history.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/controller/copyable.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/path/road_data.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/safety/command_gate.hpp"
#include "chicane/safety/fallback.hpp"
#include "chicane/safety/guard_options.hpp"
#include "chicane/safety/measurement_monitor.hpp"
#include "chicane/safety/stop_plan.hpp"
#include "chicane/safety/stop_planner.hpp"
#include "chicane/safety/supervisor.hpp"

namespace chicane::safety {

class StopSearch;

/// The road as a guard knows it at first: `road`, where it may, or nothing yet. A guard that is off has no
/// use for one.
[[nodiscard]] road::KnownRoad known_road(const GuardOptions& options, const path::RoadData* road,
                                         const model::VehicleParams& vehicle);

/// The guard around a controller, the same for all of them (docs/safety.md):
///
///     measurement → MeasurementMonitor → controller → Supervisor → is there still a way to stop? →
///     CommandGate
///
/// With each answer that is sent there is a plan to standstill on the known road at hand, stop(). An answer
/// that would leave none is not sent, and while the supervisor wants the car stopped, the stop is driven in
/// its place. Without a known road the Fallback takes the stop's place. What was chosen, and why, is in the
/// report: StepReport::rung, `reason` and `gated`, and nothing else sets these.
///
/// A person's command (Cycle::manual) is not checked: the person drives. Whatever is measured and whatever
/// the controller does, what is sent is finite and inside the vehicle's range and rate limits. No allocation
/// after construction; bounded time beside the controller's own; one thread.
class Guard {
 public:
  /// Pre: `controller` is not null. `vehicle`: the model's parameters, and the limits of what is sent.
  /// `road`: the track's; null, or GuardRoad::kWaypoints: the guard learns it from the waypoints it is shown.
  Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
        const GuardOptions& options = {}, const path::RoadData* road = nullptr);
  /// The same with what known_road() has made before: smoothing a road takes milliseconds.
  Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
        const GuardOptions& options, road::KnownRoad road);
  ~Guard();
  /// All it knows, the controller included. Pre: the controller is Copyable.
  Guard(const Guard& other);
  Guard& operator=(const Guard&) = delete;

  /// What else holds in a cycle.
  struct Cycle {
    double interval = 0.0;  ///< since the command before [s], for the rate limit; <= 0: not limited
    std::optional<model::Command> manual{};  ///< a person's command, sent in the controller's place
  };
  /// One control cycle. Writes into `result` what the controller answered with the command that is sent, and
  /// returns the command as it was asked for, before the gate.
  model::Command step(const model::Measurement& measured, Deadline deadline, const Cycle& cycle,
                      controller::StepResult& result) noexcept;
  /// Everything learned is forgotten, the controller's part included: a new run begins.
  void reset() noexcept;
  /// The road that was told is another one: from now on the guard learns it from waypoints. Allocates.
  void forget_road();
  /// A planned lap for the controller to race by; the stops follow it, too, where the guard knows the track.
  /// It stays when a new run begins.
  void use_line(std::shared_ptr<const road::RacingRoad> lap);
  /// Other parameters of the model from now on. The limits of what is sent stay those of the beginning.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// The stop at hand after step(): from the moment at which the next command would act. Size 0: none.
  [[nodiscard]] const StopPlan& stop() const noexcept { return stop_->stop; }
  [[nodiscard]] controller::Controller& controller() noexcept { return *controller_; }
  [[nodiscard]] const controller::Controller& controller() const noexcept { return *controller_; }

 private:
  void choose(const model::Measurement& seen, const Cycle& cycle, controller::StepResult& result) noexcept;
  [[nodiscard]] bool is_way_back(const StopStart& start, const controller::StepResult& result) const noexcept;
  void accept(const model::Measurement& seen, controller::StepResult& result) noexcept;
  void fall_back(const model::Measurement& seen, controller::StepResult& result) noexcept;
  void drive_stop(const StopStart& start, controller::StepResult& result) noexcept;
  [[nodiscard]] bool keep_stop(double time, controller::StepReport& report) noexcept;
  void show_stop(const StopStart& start, controller::Plan& plan) const noexcept;
  [[nodiscard]] const model::Measurement& look(const model::Measurement& measured) noexcept;
  [[nodiscard]] std::optional<StopStart> place_on_road(double act_time) noexcept;
  /// What kind of stop is at hand.
  enum class Fit : std::uint8_t {
    kNone,   ///< none that keeps the margin
    kSeen,   ///< one that does while it is known where the car is
    kBlind,  ///< and when a receiver plays it blindly for as long as a silence may last
  };
  [[nodiscard]] Fit leaves_a_stop(const StopStart& start, const model::Command& command,
                                  const controller::Plan& intended, double interval,
                                  controller::StepReport& report) noexcept;
  [[nodiscard]] bool hold_back(const StopStart& start, double interval,
                               controller::StepResult& result) noexcept;
  struct StopWish {
    bool is_driven = false;                      ///< the car is being stopped
    bool is_hard = false;                        ///< as short as can be
    const controller::Plan* intended = nullptr;  ///< by the controller
    bool slides = false;  ///< the tyres are used so much that only a stop that is searched for will do
  };
  [[nodiscard]] Fit plan_stop(const StopStart& from, double edge_before, const StopWish& wish,
                              controller::StepReport& report) noexcept;
  [[nodiscard]] BlindCheck played_edge(const StopStart& from, double time) const noexcept;

  Owned<controller::Controller> controller_;
  GuardOptions options_;
  MeasurementMonitor monitor_;
  Supervisor supervisor_;
  Fallback fallback_;
  CommandGate gate_;
  road::KnownRoad road_;
  controller::StateEstimator estimator_;
  controller::DirectionWatch direction_;  ///< by what is measured, plausible or not
  controller::CommandHistory sent_;
  StopPlanner planner_;
  Owned<StopSearch> search_;
  model::PredictionModel model_;
  double floor_ = -1e9;      ///< how far from the edge a car beyond the margin has been since [m]
  double leniency_ = 0.05;   ///< how much nearer to the edge it may come, slowly [m]
  Owned<StopCourse> stop_;   ///< at hand
  Owned<StopCourse> tried_;  ///< one that may become it
  Owned<StopCourse> last_;   ///< that of the cycle before
  double s_ = 0.0;           ///< on the known road where the command acts [m]
  unsigned revision_ = 0;
  bool has_place_ = false;
  bool is_far_ = false;     ///< the known road is, from the car
  bool races_ = false;      ///< by a planned lap: the law's stops are not enough
  double sent_from_ = 0.0;  ///< from which the command of this cycle acts [s]
};

}  // namespace chicane::safety
