// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "chicane/base/deadline.hpp"
#include "chicane/base/owned.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/prediction.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/known_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/safety/actuator_estimator.hpp"
#include "chicane/safety/actuator_watch.hpp"
#include "chicane/safety/fallback.hpp"
#include "chicane/safety/guard_options.hpp"
#include "chicane/safety/measurement_monitor.hpp"
#include "chicane/safety/predictive_filter.hpp"
#include "chicane/safety/stop_planner.hpp"
#include "chicane/safety/stop_player.hpp"
#include "chicane/safety/supervisor.hpp"
#include "chicane/tracking/state_estimator.hpp"

namespace chicane::safety {

/// The road as a guard knows it at first: `road`, where it may, or nothing yet. A guard that is off has no
/// use for one.
[[nodiscard]] road::KnownRoad known_road(const GuardOptions& options, const road::RoadData* road,
                                         const model::VehicleParams& vehicle);

/// The guard around a controller, the same for all of them (docs/safety.md). A cycle, step():
///
///     1 learned     what was learned of steering and delay is driven with           take_up_actuators
///     2 look        what of the measurement is plausible; road, actuators and       MeasurementMonitor
///                   estimate take it in; a car that was put elsewhere begins anew   ResetWatch
///     3 controller  its answer; it begins anew after a second without one           watch_answer
///     4 choose      the command, the first of these that applies:
///         off, or a person drives: the answer, or the Fallback; nothing is checked  accept, fall_back
///         no finding lasts (Supervisor), the car is on its road, and the answer
///         leaves a way to stop (PredictiveFilter), or it is not known where the
///         car is: the answer                                                        filter, accept
///         the car stands and is measured elsewhere: half a car length of driving    try_reset
///         it is off its road, or stands refused: walking pace back to the line      lead_back
///         the stored way to stop; the Fallback where no place on a road is known    drive_backup
///     5 limits      a stuck car's pedals are released; range, rate, no reverse      free_stuck_car, limited
///     6 send        the command for the actuators as they answer; CommandGate       send
///
/// GuardMode::kObserve does the same up to the filter, and sends the answer. Away from a planned lap each
/// answer that passed the filter comes with a way to stop, stop(). What was chosen, and why, is in report().
///
/// Numbers have their unit in brackets. Where they come from stands beside them or above their list: an
/// equation of docs/guard.md, a derivation, a measurement, or *chosen*: by trial, no derivation gives it, and
/// the runs of docs/measured/safety.md are its check.
///
/// A person's command (Cycle::manual) is not checked: the person drives. Whatever is measured and whatever
/// the controller does, what is sent is finite and inside the vehicle's range and rate limits. No allocation
/// after construction; bounded time beside the controller's own; one thread.
class Guard {
 public:
  /// Pre: `controller` is not null. `vehicle`: the model's parameters, and the limits of what is sent.
  /// `road`: the track's; null, or GuardRoad::kWaypoints: the guard learns it from the waypoints it is shown.
  Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
        const GuardOptions& options = {}, const road::RoadData* road = nullptr);
  /// The same with what known_road() has made before: smoothing a road takes milliseconds.
  Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
        const GuardOptions& options, road::KnownRoad road);
  /// All it knows, the controller included. Pre: the controller is Copyable.
  Guard(const Guard&) = default;
  Guard& operator=(const Guard&) = delete;

  /// What else holds in a cycle.
  struct Cycle {
    double interval = 0.0;  ///< since the command before [s], for the rate limit; <= 0: not limited
    std::optional<model::Command> manual{};  ///< a person's command, sent in the controller's place
    double longest = 0.0;                    ///< interval lately [s]: commands are held for so long
  };
  /// One control cycle. Writes into `result` what the controller answered with the command that is sent, and
  /// returns the command as it was asked for, before the gate.
  model::Command step(const model::Measurement& measured, Deadline deadline, const Cycle& cycle,
                      controller::StepResult& result) noexcept;
  /// Of the last step().
  [[nodiscard]] const GuardReport& report() const noexcept { return report_; }
  /// Everything learned is forgotten, the controller's part included: a new run begins.
  void reset() noexcept;
  /// The car is on another road than configured: from now on the guard learns it from waypoints. Allocates.
  void forget_road();
  /// A planned lap for the controller to race by; the stops follow it, too, where the guard knows the track,
  /// and count with its grip.
  /// It stays when a new run begins.
  void use_line(std::shared_ptr<const road::RacingRoad> lap);
  /// Other parameters of the model from now on. The limits of what is sent stay those of the beginning.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// The stop at hand after step(): from the moment at which the next command would act. Size 0: none.
  /// As commands for the actuators, like the command that is sent.
  [[nodiscard]] const StopPlan& stop() const noexcept { return answer_.is_usual() ? filter_.stop() : stop_; }
  [[nodiscard]] controller::Controller& controller() noexcept { return *controller_; }
  [[nodiscard]] const controller::Controller& controller() const noexcept { return *controller_; }

 private:
  // Chosen. A stop ends at 0.3 m/s (StopPlanner), so that a stopped car stands; a trial takes about 2 s.
  static constexpr double kStandingSpeed = 0.5;    ///< [m/s]
  static constexpr double kStuckTime = 3.0;        ///< [s] a car that should move may stand
  static constexpr double kAskPause = 4.0;         ///< [s] after the first trial of a car in doubt
  static constexpr double kGuessedWidth = 1.0;     ///< [m] by which an assumed width may be too small
  static constexpr double kRollsBackAtMost = 3.0;  ///< [m/s] faster, not the car rolls: its heading is wrong

  void take_up_line() noexcept;
  void note_residual(const model::State& expected, double time) noexcept;
  void choose(const model::Measurement& seen, const Cycle& cycle, controller::StepResult& result) noexcept;
  [[nodiscard]] bool filter(const StopStart& start, const Cycle& cycle,
                            controller::StepResult& result) noexcept;
  [[nodiscard]] Fit verify(const StopStart& start, const Cycle& cycle, const model::Command& command,
                           bool is_led = false) noexcept;
  [[nodiscard]] bool slow_down(const StopStart& start, const Cycle& cycle,
                               controller::StepResult& result) noexcept;
  [[nodiscard]] model::Command limited(const model::Command& command, double interval) const noexcept;
  void accept(const model::Measurement& seen, controller::StepResult& result) noexcept;
  void fall_back(const model::Measurement& seen, controller::StepResult& result) noexcept;
  void take_over(const model::Command& command, controller::Rung rung,
                 controller::StepResult& result) noexcept;
  [[nodiscard]] bool drive_backup(const StopStart& start, controller::StepResult& result) noexcept;
  void show_backup(const StopStart& start, controller::Plan& plan) const noexcept;
  void watch_course(const std::optional<StopStart>& start) noexcept;
  /// By the estimate.
  [[nodiscard]] bool stands() const noexcept { return std::fabs(estimator_.state().vx) < kStandingSpeed; }
  [[nodiscard]] bool idles(const controller::StepResult& result) const noexcept;
  [[nodiscard]] bool should_lead_back(double time, bool has_answer) noexcept;
  [[nodiscard]] bool lead_back(double act, const Cycle& cycle, controller::StepResult& result) noexcept;
  [[nodiscard]] model::VehicleParams led_vehicle() const noexcept;
  [[nodiscard]] bool turns_as_asked(double time, const model::State& car) noexcept;
  [[nodiscard]] double against_rolling_back() const noexcept;
  void watch_for_reset(const model::Measurement& measured) noexcept;
  [[nodiscard]] bool may_ask(const model::Measurement& measured) const noexcept;
  [[nodiscard]] bool agrees_with_road(const model::Measurement& measured) const noexcept;
  void begin_here() noexcept;
  void watch_answer(const model::Measurement& seen, bool has_answer) noexcept;
  [[nodiscard]] bool try_reset(const std::optional<StopStart>& start, const Cycle& cycle, double time,
                               controller::StepResult& result) noexcept;
  void watch_rest(double time, double throttle) noexcept;
  void free_stuck_car(double time, double interval, controller::StepResult& result) noexcept;
  [[nodiscard]] const model::Measurement& look(const model::Measurement& measured) noexcept;
  void set_grip(double share) noexcept;
  void count_with_actuators() noexcept;
  void watch_actuators(const model::Measurement& seen) noexcept;
  void take_up_actuators() noexcept;
  void count_with_answer() noexcept;
  void report_learned(controller::LearnedCar& learned) const noexcept;
  void begin_with(const model::Command& acting, double time) noexcept;
  void send(const Cycle& cycle, const model::Command& asked, controller::StepResult& result) noexcept;
  [[nodiscard]] std::optional<StopStart> place_on_road(double act_time) noexcept;

  Owned<controller::Controller> controller_;
  model::VehicleParams vehicle_;  ///< as configured
  double grip_ = 1.0;             ///< of the planned lap, over that
  GuardOptions options_;
  MeasurementMonitor monitor_;
  ResetWatch reset_watch_;
  // How the actuators answer: in the long run, beyond that at this moment, and both together.
  ActuatorWatch actuators_;  ///< finds a difference from what was learned within a second
  ActuatorEstimator learned_;
  ActuatorAnswer answer_;  ///< that commands are sent for
  Supervisor supervisor_;
  Fallback fallback_;
  CommandGate gate_;
  road::KnownRoad road_;
  tracking::StateEstimator estimator_;
  tracking::DirectionWatch direction_;  ///< by what is measured, plausible or not
  tracking::CommandHistory commanded_;  ///< commands as the actuators got them
  tracking::CommandHistory sent_;  ///< their effect by answer_: angles of the wheels, which models follow
  GuardReport report_;
  StopPlan stop_;  ///< the stop at hand, for actuators that answer otherwise
  PredictiveFilter filter_;
  model::PredictionModel model_;
  double s_ = 0.0;  ///< on the known road where the command acts [m]
  double d_ = 0.0;  ///< to the left of its line [m]
  unsigned revision_ = 0;
  /// When something began [s]: empty until it is asked for or set, so that no clock's zero is taken for it.
  struct Since {
    double at = std::numeric_limits<double>::infinity();
    /// For how long it has lasted. It begins at `time` where it has not, or where the clock went back.
    [[nodiscard]] double lasts(double time) noexcept {
      if (!(at <= time)) at = time;
      return time - at;
    }
  };
  /// What a run has shown of the car and its controller. All of it is forgotten when another begins.
  struct Run {
    bool has_place = false;
    bool is_far = false;            ///< the car is far from the known road
    bool is_astray = false;         ///< it is off the road or across it
    bool has_stood_astray = false;  ///< since it is astray; from then on it may leave the road to turn
    bool is_led = false;            ///< it stood while commands were refused, and is led back to the line
    bool creeps = false;            ///< it has begun an arc beside the edge
    bool goes_round = false;        ///< direction of that arc: the long way round
    bool is_idle = false;           ///< its controller does not drive a car that stands, or is led
    bool rests = false;             ///< it came to rest, and has not been asked to drive since
    bool is_by_hand = false;        ///< a person drove in the last cycle
    bool has_jumped_aside = false;  ///< the measured place, of its road, since something is in doubt
    double ask_at = 0.0;            ///< from when on a car in doubt may be tried again [s]
    double ask_pause = kAskPause;   ///< after the next trial [s]
    double tried = 0.0;             ///< way driven to see whether the car was put elsewhere, by the model [m]
    double held_speed = 0.0;        ///< of a car that should move, when it began not to [m/s]
    double led_at = 0.0;            ///< it is led, last [s]
    model::Pose led_from{};         ///< pose of the car at led_at
    double led_heading = 0.0;       ///< heading when its turning was judged last [rad]
    double led_asked = 0.0;         ///< turning by its wheels' angle since [rad]
    double stays_until = 0.0;       ///< its wheels turned it otherwise than asked [s]
    Since answered;                 ///< the controller, last
    Since still;                    ///< ResetWatch waits, and the car stands by the estimate
    Since refused;                  ///< the car stands or is led, and no answer has moved it
    Since moved;                    ///< faster than at rest, last
    Since stuck;                    ///< a car that should move does not
    Since released;                 ///< its brake, or began to be stuck
  };
  Run run_;
  double act_speed_ = 0.0;  ///< estimated where the command acts, by place_on_road(); infinite: unknown [m/s]
  double most_drive_ = 0.0;  ///< acceleration that the tyres can give then (eq. 14) [m/s²]
  double sent_from_ = 0.0;   ///< from which the command of this cycle acts [s]
};

}  // namespace chicane::safety
