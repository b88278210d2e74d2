// SPDX-License-Identifier: MIT
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

/// Clock's effect on a recorded control step: given it, a run in real time is computed again bit for bit.
struct GivenStep {
  double delay = 0.0;                   ///< measured delay [s]
  std::uint32_t deadline_spent_at = 0;  ///< DeadlineLog::spent_at
};

/// Changes signals between car and control cycle that no fault of the list changes (sim/fault.hpp): the seam
/// for experiments that attack the guard. Called after the scenario's faults; empty functions are not called.
/// Must not throw.
struct Interceptor {
  std::function<void(model::Measurement&)> measured{};           ///< once in each control cycle
  std::function<void(double time, model::Command&)> actuated{};  ///< in each physics step and control cycle
};

/// One experiment: controller against plant, in virtual time. The same object is run flat out
/// (run_closed_loop) and paced by the clock (run_realtime); given the same scenario it does the same,
/// bit for bit, as long as no deadline is spent.
///
/// Time advances by physics steps. Every control period the plant is measured, the controller asked, its
/// command gated and sent to act `latency` later. advance() allocates nothing. One thread.
class ClosedLoop {
 public:
  /// Builds track, plant and controller. Fails as make.hpp does, and as `make` does. `make` is a factory of
  /// a controller of the program's own (examples/03_your_own_controller.cpp), or Factories with a plant or a
  /// track, too.
  [[nodiscard]] static Result<std::unique_ptr<ClosedLoop>> create(const scenario::Scenario& scenario,
                                                                  const Factories& make = {});
  /// Creates one of many runs: everything that runs on a road share is taken from `roads`.
  [[nodiscard]] static Result<std::unique_ptr<ClosedLoop>> create(const scenario::Scenario& scenario,
                                                                  Roads& roads, const Factories& make = {});
  /// The same on a road that was prepared (Roads::prepare), whatever scenario.track says.
  [[nodiscard]] static Result<std::unique_ptr<ClosedLoop>> create(const scenario::Scenario& scenario,
                                                                  const Roads::Prepared& road,
                                                                  const Factories& make = {});

  /// One physics step, preceded by a control step when one is due. True when there was a control step:
  /// frame() is new. `budget` [s] bounds the control step; 0 = no bound.
  bool advance(double budget = 0.0) noexcept;
  /// The same, with the clock of a recording: `given` is what holds in the control step when one is due.
  bool advance(const GivenStep& given) noexcept;
  /// Takes the measurement of the control step that is due, which the next advance() then uses: what an agent
  /// sees before it says what that step's command is. Changes nothing that is computed later. Without a step
  /// that is due: the measurement of the last one.
  const model::Measurement& look() noexcept;
  /// The next advance() begins with the control step number cycle().
  [[nodiscard]] bool is_control_due() const noexcept { return time() >= next_control_ - 1e-9; }
  [[nodiscard]] std::uint64_t cycle() const noexcept { return cycle_.next(); }
  /// Applies a setting before the next control step. Learned values and commands in flight stay. A field of
  /// the scenario that is not live (protocol::is_live) changes nothing. Allocates nothing; call it between
  /// two advance(). Only a LearnedLap from a recording allocates and takes seconds.
  void apply(const Setting& setting) noexcept;
  /// The same for a change that is still text; one that read_setting() refuses changes nothing. Allocates.
  void apply(const telemetry::Change& change);
  /// A planned lap to race by from the next control step on, where controller().wants_lap().
  void use_line(std::shared_ptr<const road::RacingRoad> lap) {
    lap_ = lap;
    cycle_.use_line(std::move(lap));
  }
  /// Run seconds that were asked for per second of the clock.
  [[nodiscard]] double pace() const noexcept { return pace_; }
  /// Switches a fault (sim/fault.hpp) on, for its own duration and with its own strength, or off. False, and
  /// nothing changes, for a name that is none. Call it between two advance(). What is on is in
  /// Frame::active_faults.
  bool set_fault(std::string_view name, bool on) noexcept;
  /// Switches a fault on as `event` says, as if the scenario had had it from the beginning. Pre: it begins in
  /// the next advance().
  void set_fault(const sim::FaultEvent& event) noexcept { faults_.set(event); }
  /// Installs functions that are called from the next advance() on. A copy() calls the same functions.
  void intercept(Interceptor interceptor) { interceptor_ = std::move(interceptor); }
  /// Stands the car at `pose`, as a simulator's reset does: controller and guard are not informed. Call it
  /// between two advance().
  void put_car(const model::Pose& pose) noexcept { car_.world.put(pose); }
  /// All laps driven, the car lost, or time up (Account).
  [[nodiscard]] bool is_over() const noexcept { return car_.account.is_over(); }
  /// A lap that the last advance() completed, once.
  [[nodiscard]] std::optional<telemetry::CompletedLap> take_lap() noexcept { return car_.account.take_lap(); }
  /// Continues after the last lap: is_over() only when the car is lost, which restarts it. Further laps are
  /// counted and remembered like the others.
  void drive_on();
  /// Puts the car at the start, resets the controller and restarts the account. Allocates.
  void restart();
  /// Restarts from any pose and motion, on the road or off it.
  void restart_at(const model::State& start);

  /// Takes up a control step of a car that another controller drove: at `time` [s] it moved like `car`, and
  /// was sent `sent`, which acts `delay` [s] later. The controller plans and learns as during manual driving;
  /// after the last such step advance() drives. Times rise. Does not allocate.
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
  ClosedLoop(const ClosedLoop& other) = default;
  ClosedLoop(const scenario::Scenario& scenario, const Roads::Prepared& road,
             std::unique_ptr<sim::Plant> plant, std::unique_ptr<controller::Controller> controller);
  void control(double budget, const GivenStep* given, const model::Command* sent = nullptr) noexcept;
  void take(std::monostate) noexcept {}
  void take(const FieldValue& field) noexcept;
  void take(const Pace& pace) noexcept { pace_ = pace.value; }
  void take(const ManualSetting& setting) noexcept { manual_.set(setting); }
  void take(const FaultSwitch& fault) noexcept;
  void take(LearnedLap lap) noexcept;
  void watch_faults() noexcept;
  [[nodiscard]] model::Command acting() noexcept;
  [[nodiscard]] model::Measurement measure() noexcept;
  [[nodiscard]] model::Measurement take_measurement() noexcept;
  void move() noexcept;

  scenario::Scenario scenario_;
  SimulatedCar car_;
  ControlCycle cycle_;
  ManualDrive manual_;
  double pace_ = 1.0;
  sim::FaultLab faults_;
  Interceptor interceptor_;
  std::shared_ptr<const road::RacingRoad> lap_;  ///< planned lap to race by; null: none
  telemetry::Frame frame_;
  std::optional<model::Measurement> seen_;  ///< measurement by look() for the step that is due
  double next_control_ = 0.0;
  double step_time_ = 0.0;  ///< duration of the control step, smoothed; 0 in virtual time [s]
  /// Time at which the last command acts by the configured latency [s].
  double configured_act_time_ = -std::numeric_limits<double>::infinity();
};

/// The scenario without an end and without its faults.
[[nodiscard]] scenario::Scenario endless(scenario::Scenario scenario);

/// Called during a run on the thread that runs it; must not block. Empty functions are not called.
struct RunHooks {
  std::function<void(const telemetry::Frame&)> on_frame{};       ///< called after each control cycle
  std::function<void(const telemetry::CompletedLap&)> on_lap{};  ///< called after each lap, the last one too
  std::function<void(const telemetry::Change&)> on_change{};     ///< was applied, before the next cycle
  /// The run is over and is driven on (RealtimeOptions::stay_at_end); again and again.
  std::function<void()> on_over{};
};

/// Runs to the end as fast as the machine can. `stop` is asked once per cycle and ends the run with what
/// there is.
[[nodiscard]] telemetry::RunSummary run_closed_loop(ClosedLoop& loop, const RunHooks& hooks = {},
                                                    const std::function<bool()>& stop = {});

}  // namespace chicane::run
