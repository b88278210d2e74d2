// SPDX-License-Identifier: MIT
// Closed loop of controller and simulated car in virtual time, with faults, settings and copies of a run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/roads.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/run/simulated_car.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/fault.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Effect of the clock on a recorded control step: with it a run in real time is computed again bit for bit.
struct GivenStep {
  double delay = 0.0;                   ///< measured delay [s]
  std::uint32_t deadline_spent_at = 0;  ///< DeadlineLog::spent_at
};

/// Functions that change the signals between car and control cycle, for attacks on the guard beyond the
/// listed faults (sim/fault.hpp). Called after the scenario's faults; empty functions are not called. Must
/// not throw.
struct Interceptor {
  std::function<void(model::Measurement&)> measured{};           ///< once in each control cycle
  std::function<void(double time, model::Command&)> actuated{};  ///< in each physics step and control cycle
};

/// One experiment: a controller drives a plant in virtual time, flat out (run_closed_loop) or paced by the
/// clock (run_realtime). Equal scenarios give equal bits, as long as no deadline is spent.
///
/// Time advances by physics steps. Each control period the plant is measured, the controller computes a
/// command, and the guarded command is sent to act `latency` later. advance() allocates nothing. One thread.
class ClosedLoop {
 public:
  /// Builds track, plant and controller. Fails as make.hpp and `make` do. `make` is a factory of the
  /// program's own controller (examples/03_your_own_controller.cpp), or Factories that make plant or track as
  /// well.
  [[nodiscard]] static Result<std::unique_ptr<ClosedLoop>> create(const scenario::Scenario& scenario,
                                                                  const Factories& make = {});
  /// Creates one of many runs: takes everything that runs on one road share from `roads`.
  [[nodiscard]] static Result<std::unique_ptr<ClosedLoop>> create(const scenario::Scenario& scenario,
                                                                  Roads& roads, const Factories& make = {});
  /// Creates a run on a prepared road, whatever scenario.track says.
  [[nodiscard]] static Result<std::unique_ptr<ClosedLoop>> create(const scenario::Scenario& scenario,
                                                                  const Roads::Prepared& road,
                                                                  const Factories& make = {});

  /// One physics step, preceded by a control step when one is due. True when there was a control step:
  /// frame() is new. `budget` [s] bounds the control step; 0 = no bound.
  bool advance(double budget = 0.0) noexcept { return advance_by({.budget = budget}); }
  /// One physics step as advance(), with the clock of a recording: a control step that is due uses `given`.
  bool advance(const GivenStep& given) noexcept { return advance_by({.given = &given}); }
  /// Measurement for the control step that is due: an agent outside reads it before it gives the step's
  /// command. The next advance() uses the same one; later results do not change. If no step is due: the
  /// measurement of the last one.
  const model::Measurement& look() noexcept;
  /// Whether the next advance() begins with a control step, whose number is cycle().
  [[nodiscard]] bool is_control_due() const noexcept { return time() >= next_control_ - 1e-9; }
  [[nodiscard]] std::uint64_t cycle() const noexcept { return cycle_.next(); }
  /// Applies a setting before the next control step. Learned values and commands in flight stay. A field of
  /// the scenario that is not live (protocol::is_live) changes nothing. Call it between two advance().
  /// Allocates nothing, except for a LearnedLap of a recording, which takes seconds.
  void apply(const Setting& setting) noexcept;
  /// Applies a change given as text; ignores a change that read_setting() refuses. Allocates.
  void apply(const telemetry::Change& change);
  /// Sets the planned lap to race by from the next control step on, if controller().wants_lap().
  void use_line(std::shared_ptr<const road::RacingRoad> lap) {
    lap_ = lap;
    cycle_.use_line(std::move(lap));
  }
  /// Run seconds per second of the clock, as configured.
  [[nodiscard]] double pace() const noexcept { return pace_; }
  /// Switches a fault (sim/fault.hpp) on, with its kind's duration and strength, or off. False for an unknown
  /// name, which changes nothing. Call it between two advance(). Frame::active_faults shows the active
  /// faults.
  bool set_fault(std::string_view name, bool on) noexcept;
  /// Switches a fault on as `event` describes it, as if the scenario had contained it. Pre: `event` begins in
  /// the next advance().
  void set_fault(const sim::FaultEvent& event) noexcept { faults_.set(event); }
  /// Installs functions that are called from the next advance() on. A copy() calls the same functions.
  void intercept(Interceptor interceptor) { interceptor_ = std::move(interceptor); }
  /// Puts the car at rest at `pose`, as the reset of a simulator does: controller and guard are not informed.
  /// Call it between two advance().
  void put_car(const model::Pose& pose) noexcept { car_.world.put(pose); }
  /// Whether all laps are driven, the car is lost, or the time is up (Account).
  [[nodiscard]] bool is_over() const noexcept { return car_.account.is_over(); }
  /// Lap that the last advance() completed, returned once.
  [[nodiscard]] std::optional<telemetry::CompletedLap> take_lap() noexcept { return car_.account.take_lap(); }
  /// Continues after the end: from now on only a lost car ends the run. A car that is lost now restarts.
  /// Further laps are counted and remembered like the others.
  void drive_on();
  /// Puts the car at the start, resets the controller and restarts the account. Allocates.
  void restart();
  /// Restarts from any pose and motion, on the road or off it.
  void restart_at(const model::State& start);

  /// Repeats a control step of a car that another controller drove: at `time` [s], which rises, its state was
  /// `car` and its command `sent`, which acts `delay` [s] later. Our controller plans and learns as during
  /// manual driving, and drives from the next advance() on. Does not allocate.
  void follow(double time, const model::State& car, double delay, const model::Command& sent) noexcept;

  /// Copy of the run in its current state: both continue with the same bits. Null if controller or plant
  /// cannot be copied (controller/controller.hpp). Allocates some 8 MB.
  [[nodiscard]] std::unique_ptr<ClosedLoop> copy() const;

  [[nodiscard]] double time() const noexcept { return car_.world.time(); }
  [[nodiscard]] const telemetry::Frame& frame() const noexcept { return frame_; }
  [[nodiscard]] const road::Track& track() const noexcept { return car_.track; }
  [[nodiscard]] const sim::WorldState& world() const noexcept { return car_.world.state(); }
  /// State of the car after the last physics step.
  [[nodiscard]] const model::State& car() const noexcept { return car_.plant->state(); }
  [[nodiscard]] const scenario::Scenario& scenario() const noexcept { return scenario_; }
  [[nodiscard]] const controller::Controller& controller() const noexcept { return cycle_.controller(); }
  [[nodiscard]] telemetry::RunSummary summary() const;

 private:
  /// Builds without checking that the car gets round the road.
  [[nodiscard]] static Result<std::unique_ptr<ClosedLoop>> build(const scenario::Scenario& scenario,
                                                                 const Roads::Prepared& road,
                                                                 const Factories& make);
  /// Clock and command of a control step.
  struct StepTerms {
    double budget = 0.0;                   ///< longest duration [s]; 0: no bound
    const GivenStep* given = nullptr;      ///< recorded clock; null: the measured delay holds
    const model::Command* sent = nullptr;  ///< command of another controller; null: ours drives
  };

  ClosedLoop(const ClosedLoop& other) = default;
  ClosedLoop(const scenario::Scenario& scenario, const Roads::Prepared& road,
             std::unique_ptr<sim::Plant> plant, std::unique_ptr<controller::Controller> controller);
  /// One physics step, preceded by a control step when one is due; true when there was one.
  bool advance_by(const StepTerms& terms) noexcept;
  /// One control step: measures, computes a command, and sends it.
  void control(const StepTerms& terms) noexcept;
  // Effects of a setting, one for each kind of Action.
  void take(std::monostate) noexcept {}
  void take(const FieldValue& field) noexcept;
  void take(const Pace& pace) noexcept { pace_ = pace.value; }
  void take(const ManualSetting& setting) noexcept { manual_.set(setting); }
  void take(const FaultSwitch& fault) noexcept;
  void take(LearnedLap lap) noexcept;
  /// Begins and ends faults; the plant feels them from this physics step on.
  void update_faults() noexcept;
  /// Command that the actuators execute now: the newest that has arrived; after a command timeout the braking
  /// of the receiver.
  [[nodiscard]] model::Command acting() noexcept;
  /// Measurement that the controller gets now, faults included.
  [[nodiscard]] model::Measurement measure() noexcept;
  /// Measurement for the control step that is due: the one that look() kept, or a new one.
  [[nodiscard]] model::Measurement take_measurement() noexcept;
  /// Advances the car by one physics step.
  void move() noexcept;

  scenario::Scenario scenario_;
  SimulatedCar car_;
  ControlCycle cycle_;
  ManualDrive manual_;  ///< person at the wheel
  double pace_ = 1.0;   ///< run seconds per second of the clock
  sim::FaultLab faults_;
  Interceptor interceptor_;
  std::shared_ptr<const road::RacingRoad> lap_;  ///< planned lap to race by; null: none
  telemetry::Frame frame_;
  std::optional<model::Measurement> seen_;  ///< measurement that look() kept for the step that is due
  double next_control_ = 0.0;               ///< time of the next control step [s]
  double step_time_ = 0.0;                  ///< duration of the control step, smoothed; 0 in virtual time [s]
  /// Time at which the last command acts by the configured latency [s].
  double configured_act_time_ = -std::numeric_limits<double>::infinity();
};

/// Copy of a scenario without laps, time limit and faults.
[[nodiscard]] scenario::Scenario endless(scenario::Scenario scenario);

/// Called during a run on the thread that runs it; must not block. Empty functions are not called.
struct RunHooks {
  std::function<void(const telemetry::Frame&)> on_frame{};       ///< called after each control cycle
  std::function<void(const telemetry::CompletedLap&)> on_lap{};  ///< called after each lap, the last one too
  std::function<void(const telemetry::Change&)> on_change{};     ///< called after a change was applied
  /// Called each time that the run is over and continues (RealtimeOptions::stay_at_end).
  std::function<void()> on_over{};
};

/// Runs to the end as fast as the machine can. `stop` is asked after each control cycle; true ends the run
/// with the results so far.
[[nodiscard]] telemetry::RunSummary run_closed_loop(ClosedLoop& loop, const RunHooks& hooks = {},
                                                    const std::function<bool()>& stop = {});

}  // namespace chicane::run
