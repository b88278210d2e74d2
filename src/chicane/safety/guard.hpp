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

/// Road that a guard begins with: `road` if `options` say GuardRoad::kTrack, else one that waypoints will
/// fill. A guard that is off needs none, and gets an empty one.
[[nodiscard]] road::KnownRoad known_road(const GuardOptions& options, const road::RoadData* road,
                                         const model::VehicleParams& vehicle);

/// Safety filter around any controller (docs/safety.md). One cycle, step(), has six stages:
///
///     1 actuators   takes up what was learned of steering and delay               adopt_learned_answer
///     2 look        gives the plausible part of the measurement to road,          MeasurementMonitor,
///                   actuators and estimate; starts again if the car was moved     ResetWatch
///     3 controller  takes its answer; resets it after a second without one        watch_answer
///     4 choose      chooses a command, see below                                  choose
///     5 limits      releases the pedals of a stuck car; range, rate, no reverse   free_stuck_car, limited
///     6 send        translates for the actuators as they answer; CommandGate      send
///
/// Stage 4 takes the first row whose condition holds:
///
///     the guard is off, or a person drives       controller's answer, else Fallback    accept, fall_back
///     no doubt lasts (Supervisor), the car is    controller's answer                   filter, accept
///     not astray, and a stop exists after the
///     answer or the car's place is not known
///     a doubt lasts, the car stands              trial: half a car length              try_reset
///     the car is astray, or stands refused       walking pace back to the line         lead_back
///     the car's place on the road is known       the stored stop                       drive_stop
///     none of these                              Fallback                              fall_back
///
/// GuardMode::kObserve computes the first two rows, and sends the controller's answer. After each answer that
/// passed the filter a stop() is stored, except along a planned lap. report() says what was sent and why.
///
/// Numbers have their unit in brackets, and their origin beside them or above their list: an equation of
/// docs/guard.md, a derivation, a measurement, or *chosen*: found by trial, checked by the runs of
/// docs/measured/safety.md.
///
/// A person's command (Cycle::manual) is sent without a check. Every sent command is finite and inside the
/// vehicle's limits of range and rate, whatever sensors and controller deliver. No allocation after
/// construction; bounded time beside the controller's own; one thread.
class Guard {
 public:
  /// Pre: `controller` is not null. `vehicle`: parameters of the model, and limits of the sent commands.
  /// `road`: road of the track; ignored with GuardRoad::kWaypoints. Without one the guard learns the road
  /// from the waypoints of the measurements.
  Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
        const GuardOptions& options = {}, const road::RoadData* road = nullptr);
  /// The same with a road that known_road() made earlier, because smoothing a road takes milliseconds.
  Guard(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
        const GuardOptions& options, road::KnownRoad road);
  /// Copies the guard with its controller, to drive on from the same moment. Pre: the controller is Copyable.
  Guard(const Guard&) = default;
  Guard& operator=(const Guard&) = delete;

  /// Timing of one control cycle, and the command of a person who drives.
  struct Cycle {
    double interval = 0.0;  ///< time since the last command [s], for the rate limit; <= 0: no rate limit
    std::optional<model::Command> manual{};  ///< a person's command, sent in the controller's place
    double longest = 0.0;                    ///< longest recent interval [s]: a command may be held so long
  };
  /// Runs one control cycle. `result` receives the controller's answer with the command that is sent. Returns
  /// the chosen command before the gate limits it.
  model::Command step(const model::Measurement& measured, Deadline deadline, const Cycle& cycle,
                      controller::StepResult& result) noexcept;
  /// The pedals are released although each command that may act drives, held for `longest` [s]: commands come
  /// later, and the receiver stops the car in between (docs/guard.md, "The condition for sending").
  [[nodiscard]] bool is_stopped_by_receiver(const model::Measurement& measured,
                                            double longest) const noexcept;
  /// Decision of the last step(), with its reason.
  [[nodiscard]] const GuardReport& report() const noexcept { return report_; }
  /// Begins a new run: guard and controller forget everything that they learned, except a line of use_line().
  void reset() noexcept;
  /// Drops the configured road, on which the car is not. The guard learns the road from waypoints instead.
  /// Allocates.
  void forget_road();
  /// Sets the planned lap that the controller races by; null: none. Stops count with the lap's grip, and
  /// follow its line if the lap was planned on the road that the guard knows. Stays when a new run begins.
  void use_line(std::shared_ptr<const road::RacingRoad> lap);
  /// Changes the parameters of the model. The sent commands keep the constructor's limits.
  void set_vehicle(const model::VehicleParams& vehicle) noexcept;

  /// The stored stop after step(), as commands for the actuators. Begins when the next command would act.
  /// Size 0: none is stored.
  [[nodiscard]] const StopPlan& stop() const noexcept { return answer_.is_usual() ? filter_.stop() : stop_; }
  [[nodiscard]] controller::Controller& controller() noexcept { return *controller_; }
  [[nodiscard]] const controller::Controller& controller() const noexcept { return *controller_; }

 private:
  static constexpr double kStandingSpeed = 0.5;  ///< [m/s] a slower car stands; chosen
  static constexpr double kDrives = 0.1;         ///< pedal from which on a car should move; chosen
  static constexpr double kStuckTime = 3.0;      ///< [s] docs/safety.md, condition "stuck"
  static constexpr double kAskPause = 4.0;       ///< [s] between first and second trial (docs/safety.md)
  static constexpr double kGuessedWidth = 1.0;   ///< [m] error allowed of an assumed half width; chosen
  /// [m/s] Car moving backwards faster than this does not roll back: its measured heading is wrong. Chosen.
  static constexpr double kRollsBackAtMost = 3.0;

  // The measurement: what of it is plausible, and what it tells of car, road and actuators.
  /// Stage 2 of a cycle; returns what the controller gets.
  [[nodiscard]] const model::Measurement& take_in(const model::Measurement& measured) noexcept;
  /// Difference between the estimate and its prediction `expected`: a verified stop has to cover it (eq. 5c).
  void note_residual(const model::State& expected, double time) noexcept;
  /// Drops the place along a line that the road has replaced.
  void adopt_line() noexcept;
  /// Sets grip_.
  void set_grip(double share) noexcept;
  /// State of the car along the road when a command acts at `act_time` [s]; none: car or road are lost.
  [[nodiscard]] std::optional<StopStart> place_on_road(double act_time) noexcept;

  // The command: the controller's, a slower one, the stored stop or the fallback.
  /// Stage 4 of a cycle.
  void choose(const model::Measurement& seen, const Cycle& cycle, controller::StepResult& result) noexcept;
  /// Whether the answer may be sent, after slow_down() where it leaves only a closed-loop stop.
  [[nodiscard]] bool may_send(const StopStart& start, const Cycle& cycle,
                              controller::StepResult& result) noexcept;
  /// PredictiveFilter::verify() of the command that the gate would send.
  [[nodiscard]] Fit verify(const StopStart& start, const Cycle& cycle, const model::Command& command,
                           bool is_led = false) noexcept;
  /// Limits the pedal to gentle braking; false: no stop follows even then.
  [[nodiscard]] bool slow_down(const StopStart& start, const Cycle& cycle,
                               controller::StepResult& result) noexcept;
  /// The command inside range, rate and traction, without the reverse gear.
  [[nodiscard]] model::Command limited(const model::Command& command, double interval) const noexcept;
  /// Sends the controller's answer, and gives its plan to the fallback.
  void accept(const model::Measurement& seen, controller::StepResult& result) noexcept;
  /// Sends the fallback's command.
  void fall_back(const model::Measurement& seen, controller::StepResult& result) noexcept;
  /// Replaces the answer by a command of the guard.
  void take_over(const model::Command& command, controller::Rung rung,
                 controller::StepResult& result) noexcept;
  /// Sends the stored stop; false: there is none.
  [[nodiscard]] bool drive_stop(const StopStart& start, controller::StepResult& result) noexcept;
  /// Writes the stored stop to `plan`, for viewers.
  void show_stop(const StopStart& start, controller::Plan& plan) const noexcept;
  /// Begins commanded_ and sent_ with the command that acts before the first one of a run.
  void begin_with(const model::Command& acting, double time) noexcept;
  /// Stage 6 of a cycle. `asked`: the command before stage 5.
  void send(const Cycle& cycle, const model::Command& asked, controller::StepResult& result) noexcept;

  // The way back of a car that is off its road, across it, stuck at its edge, or rolls back.
  /// A car that is led back, when its next command acts.
  struct LedCar {
    model::State state;
    model::VehicleParams vehicle;      ///< car with the lock that its wheels reach
    std::optional<StopStart> start{};  ///< state along the road; none: car or road are lost
    bool stands = false;               ///< slower than kStandingSpeed, and does not roll back
    bool is_on_road = false;           ///< all contact patches are inside the edges
    bool may_creep = false;            ///< on the road, and slow enough to turn on an arc beside the edge
    double hold = 0.0;                 ///< time for which a command may act [s]
    double doubt = 0.0;                ///< by which the end of an arc may be predicted off the road [m]
  };
  /// Updates run_.is_astray.
  void watch_course(const std::optional<StopStart>& start) noexcept;
  /// Whether the estimated speed is below kStandingSpeed.
  [[nodiscard]] bool stands() const noexcept { return std::fabs(estimator_.state().vx) < kStandingSpeed; }
  /// Whether the controller does not drive a car that stands or is led.
  [[nodiscard]] bool idles(const controller::StepResult& result) const noexcept;
  /// Whether the car is astray, or stands while its commands are refused.
  [[nodiscard]] bool should_lead_back(double time, bool has_answer) noexcept;
  /// Walking pace on a course that meets the road; false where the car is too fast or lost.
  [[nodiscard]] bool lead_back(double act, const Cycle& cycle, controller::StepResult& result) noexcept;
  /// The arc of a car that creeps beside the edge, in place of `command`: a gentle way to the line may lead
  /// over the edge where more lock does not, or the long way round.
  void turn_beside_edge(LedCar& led, model::Command& command) noexcept;
  /// The stored stop with the wheels of result.command, or standstill with them; false where a moving car has
  /// no stop. `waits`: the wheels have not turned yet.
  [[nodiscard]] bool turn_wheels_only(const LedCar& led, bool waits, controller::StepResult& result) noexcept;
  /// Whether the arc of a creeping car with the wheels at `angle` [rad] stays on the road (eq. 6c).
  [[nodiscard]] bool stays_on_road(const LedCar& led, double angle, bool goes_round = false) const noexcept;
  /// The car with the lock that its wheels reach as they answer: who waits for more waits for ever.
  [[nodiscard]] model::VehicleParams led_vehicle() const noexcept;
  [[nodiscard]] bool turns_as_asked(double time, const model::State& car) noexcept;
  /// Pedal against rolling back, 0 for a car whose heading is wrong instead.
  [[nodiscard]] double against_rolling_back() const noexcept;
  /// Updates run_.rests.
  void watch_rest(double time, double throttle) noexcept;
  void free_stuck_car(double time, const Cycle& cycle, controller::StepResult& result) noexcept;

  // The trial of a car that was put elsewhere, or whose controller has no answer.
  void watch_for_reset(const model::Measurement& measured) noexcept;
  /// Whether a trial may begin.
  [[nodiscard]] bool may_ask(const model::Measurement& measured) const noexcept;
  /// Whether the measured place and heading are near the car's on the known road, or on the waypoints.
  [[nodiscard]] bool agrees_with_road(const model::Measurement& measured) const noexcept;
  /// Resets estimates, stored stop and controller.
  void begin_here() noexcept;
  /// Resets a controller that has had no answer for a second.
  void watch_answer(const model::Measurement& seen, bool has_answer) noexcept;
  /// Drives the trial; false: none is running.
  [[nodiscard]] bool try_reset(const std::optional<StopStart>& start, const Cycle& cycle, double time,
                               controller::StepResult& result) noexcept;

  // The actuators: how they answer, and which commands compensate for it.
  /// Sets the models to the brakes and the grip as estimated.
  void update_model_vehicle() noexcept;
  /// Updates actuators_ and learned_.
  void watch_actuators(const model::Measurement& seen) noexcept;
  /// Stage 1 of a cycle.
  void adopt_learned_answer() noexcept;
  /// Sets answer_, and sent_ by it.
  void update_answer() noexcept;
  void report_learned(controller::LearnedCar& learned) const noexcept;

  Owned<controller::Controller> controller_;
  model::VehicleParams vehicle_;  ///< as configured
  double grip_ = 1.0;             ///< grip of the planned lap over the configured grip
  GuardOptions options_;
  MeasurementMonitor monitor_;
  ResetWatch reset_watch_;
  ActuatorWatch actuators_;    ///< finds sudden changes beyond learned_
  ActuatorEstimator learned_;  ///< estimates a constant deviation from the configuration
  ActuatorAnswer answer_;      ///< deviation that sent commands compensate: learned_ and actuators_ together
  Supervisor supervisor_;
  Fallback fallback_;
  CommandGate gate_;
  road::KnownRoad road_;
  tracking::StateEstimator estimator_;
  tracking::DirectionWatch direction_;  ///< also sees measurements that the monitor rejects
  tracking::CommandHistory commanded_;  ///< commands to the actuators, with the times at which they act
  tracking::CommandHistory sent_;       ///< effect of commanded_ on wheels and pedals
  GuardReport report_;
  StopPlan stop_;  ///< the stored stop, with commands that compensate answer_
  PredictiveFilter filter_;
  model::PredictionModel model_;
  double s_ = 0.0;         ///< arc length on the known road where the command acts [m]
  double d_ = 0.0;         ///< distance from the road's line there [m], left positive
  unsigned revision_ = 0;  ///< number of the road's line that s_ and d_ refer to
  /// Start of a state [s]. Infinite until lasts() is called or `at` is set, because 0 may be a start.
  struct Since {
    double at = std::numeric_limits<double>::infinity();
    /// Duration of the state [s]. A state without a start, or with one in the future, starts at `time`.
    [[nodiscard]] double lasts(double time) noexcept {
      if (!(at <= time)) at = time;
      return time - at;
    }
  };
  /// State of car and controller in this run; cleared by reset().
  struct Run {
    bool has_place = false;         ///< s_ and d_ are valid
    bool is_far = false;            ///< the car is far from the known road
    bool is_astray = false;         ///< the car is off the road, or across it
    bool has_stood_astray = false;  ///< the astray car has stood: it may leave the road to turn
    bool is_led = false;            ///< the car stood with refused commands, and is led back to the line
    bool creeps = false;            ///< the led car drives an arc beside the edge
    bool goes_round = false;        ///< the arc of `creeps` turns the long way round
    bool is_idle = false;           ///< the controller does not drive a car that stands or is led
    bool rests = false;             ///< the car came to rest, and no drive was commanded since
    bool is_by_hand = false;        ///< a person drove in the last cycle
    bool has_jumped_aside = false;  ///< the measured place left the road since a signal is in doubt
    double ask_at = 0.0;            ///< earliest time of the next trial [s]
    double ask_pause = kAskPause;   ///< pause after the next trial [s]
    double tried = 0.0;             ///< distance driven in the running trial, by the model [m]
    double held_speed = 0.0;        ///< speed at which the stuck car stopped gaining speed [m/s]
    double led_at = 0.0;            ///< time at which the car was last led [s]
    model::Pose led_from{};         ///< pose of the car at led_at
    double led_heading = 0.0;       ///< heading at the last comparison with led_asked [rad]
    double led_asked = 0.0;         ///< turn that the wheels' angle should have made since then [rad]
    double stays_until = 0.0;       ///< end of a pause: the led car turned otherwise than its wheels [s]
    Since answered;                 ///< last answer of the controller
    Since still;                    ///< estimated standstill of a car that is measured elsewhere
    Since refused;                  ///< the car stands or is led, and no answer has moved it
    Since moved;                    ///< last motion faster than rest
    Since stuck;                    ///< standstill of a car that should move
    Since released;                 ///< last release of the brake, or start of `stuck`
  };
  Run run_;
  double act_speed_ = 0.0;   ///< estimated speed when the command acts, infinite: unknown [m/s]
  double most_drive_ = 0.0;  ///< acceleration that the tyres can transmit then (eq. 14) [m/s²]
  double sent_from_ = 0.0;   ///< time from which the command of this cycle acts [s]
};

}  // namespace chicane::safety
