// SPDX-License-Identifier: MIT
// Fields of a frame as rows: type, name, meaning and value of each, for recordings, ROS and the dashboard.
#include "chicane/protocol/frame_fields.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "chicane/base/math.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/controller/guard_words.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::protocol {
namespace {

using telemetry::Frame;
using Numbers = std::span<const double>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Name of a type in .msg files.
template <class T>
consteval std::string_view type_name() {
  if constexpr (std::is_same_v<T, Stamp>) return "builtin_interfaces/Time";
  if constexpr (std::is_same_v<T, bool>) return "bool";
  if constexpr (std::is_same_v<T, std::int8_t>) return "int8";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8";
  if constexpr (std::is_same_v<T, std::int32_t>) return "int32";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "uint32";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "uint64";
  if constexpr (std::is_same_v<T, double>) return "float64";
  if constexpr (std::is_same_v<T, Numbers>) return "float64[]";
}

/// Row of the table. T: type in the message; `value`: lambda without captures that reads the value from a
/// frame.
template <class T, class Value>
constexpr FrameField field(std::string_view name, std::string_view meaning, Value /*value*/,
                           std::span<const FrameConstant> constants = {}) {
  return {.type = type_name<T>(),
          .name = name,
          .meaning = meaning,
          .value = [](const Frame& frame) noexcept { return FrameValue{static_cast<T>(Value{}(frame))}; },
          .constants = constants};
}

template <class Enum>
constexpr FrameConstant constant(std::string_view name, Enum value, std::string_view meaning = {}) {
  return {.name = name, .value = static_cast<int>(value), .meaning = meaning};
}

using ConstantName = std::array<char, 40>;  // ends with a zero

/// Names of the constants of an enumeration: "RUNG_" and "guard_stop" give "RUNG_GUARD_STOP".
template <class Enum, std::size_t N>
consteval std::array<ConstantName, N> capital_names(std::string_view prefix,
                                                    const std::array<Word<Enum>, N>& words) {
  std::array<ConstantName, N> names{};
  for (std::size_t i = 0; i < N; ++i) {
    std::size_t at = 0;
    for (const char letter : prefix) names[i].at(at++) = letter;
    for (const char letter : words[i].name)
      names[i].at(at++) = letter == '_' ? letter : static_cast<char>(letter - 'a' + 'A');
  }
  return names;
}

template <class Enum, std::size_t N>
constexpr std::array<FrameConstant, N> constants(const std::array<ConstantName, N>& names,
                                                 const std::array<Word<Enum>, N>& words) {
  std::array<FrameConstant, N> rows{};
  for (std::size_t i = 0; i < N; ++i) {
    rows[i] = {.name = names[i].data(),
               .value = static_cast<int>(words[i].value),
               .meaning = words[i].sentence,
               .severity = words[i].severity};
  }
  return rows;
}

/// `value`, which is known where the road is judged; else not-a-number.
double judged(const Frame& frame, double value) { return frame.is_judged ? value : kNaN; }
/// `value`, which is known of a simulated car; else not-a-number.
double simulated(const Frame& frame, double value) { return frame.has_truth ? value : kNaN; }

/// Speed of the car [m/s]: the truth if the frame has it, else as measured.
double speed(const Frame& frame) {
  return frame.has_truth ? chicane::hypot(frame.truth.vx, frame.truth.vy) : frame.measurement.speed;
}

Numbers cost_terms(const Frame& frame) {
  const controller::Explanation& why = frame.result.report.explanation;
  return Numbers{why.cost_terms}.first(
      static_cast<std::size_t>(std::clamp(why.cost_term_count, 0, controller::Explanation::kMaxCostTerms)));
}

const controller::StepReport& report(const Frame& frame) { return frame.result.report; }
const controller::Explanation& why(const Frame& frame) { return frame.result.report.explanation; }
const solver::SolveReport& solve(const Frame& frame) { return frame.result.report.solve; }

constexpr std::array kTime{
    field<Stamp>("stamp", "", [](const Frame& f) { return Stamp{f.time}; }),
    field<std::uint64_t>("cycle", "number of the control cycle", [](const Frame& f) { return f.cycle; }),
    field<double>("time_s", "of the measurement, from the start of the run",
                  [](const Frame& f) { return f.time; }),
    field<bool>("has_truth", "the motion below is the simulator's truth; else as measured",
                [](const Frame& f) { return f.has_truth; }),
};

constexpr std::array kMotion{
    field<double>("x_m", "in map", [](const Frame& f) { return known_motion(f).x; }),
    field<double>("y_m", "in map", [](const Frame& f) { return known_motion(f).y; }),
    field<double>("yaw_rad", "in map, counter-clockwise positive",
                  [](const Frame& f) { return known_motion(f).psi; }),
    field<double>("vx_mps", "along the car", [](const Frame& f) { return known_motion(f).vx; }),
    field<double>("vy_mps", "to its left", [](const Frame& f) { return known_motion(f).vy; }),
    field<double>("yaw_rate_radps", "", [](const Frame& f) { return known_motion(f).r; }),
    field<double>("speed_mps", "magnitude of the velocity", [](const Frame& f) { return speed(f); }),
    field<double>("longitudinal_acceleration_mps2", "along the car",
                  [](const Frame& f) { return simulated(f, f.longitudinal_acceleration); }),
    field<double>("lateral_acceleration_mps2", "to its left",
                  [](const Frame& f) { return simulated(f, f.lateral_acceleration); }),
};

constexpr std::array kMeasured{
    field<double>("measured_x_m", "of the centre of mass, in map",
                  [](const Frame& f) { return f.measurement.x; }),
    field<double>("measured_y_m", "of the centre of mass, in map",
                  [](const Frame& f) { return f.measurement.y; }),
    field<double>("measured_yaw_rad", "", [](const Frame& f) { return f.measurement.psi; }),
    field<double>("measured_speed_mps", "", [](const Frame& f) { return f.measurement.speed; }),
};

constexpr std::array kRoad{
    field<double>("s_m", "along the centre line", [](const Frame& f) { return judged(f, f.s); }),
    field<double>("lateral_error_m", "from the centre line, left positive",
                  [](const Frame& f) { return f.lateral_error; }),
    field<double>("heading_error_rad", "yaw minus the direction of the line",
                  [](const Frame& f) { return f.heading_error; }),
    field<double>("edge_distance_m", "of the outermost tyre to the edge, negative = off the road",
                  [](const Frame& f) { return judged(f, f.edge_distance); }),
    field<bool>("is_off_track", "", [](const Frame& f) { return f.is_off_track; }),
    field<std::uint32_t>("off_track_events", "times the car left the road",
                         [](const Frame& f) { return f.off_track_events; }),
    field<std::uint32_t>("lap", "laps completed", [](const Frame& f) { return f.lap; }),
    field<double>("lap_time_s", "of the running lap", [](const Frame& f) { return judged(f, f.lap_time); }),
    field<double>("last_lap_time_s", "0 before the first completed lap",
                  [](const Frame& f) { return f.last_lap_time; }),
};

constexpr std::array kCommands{
    field<double>("steer_asked_rad", "angle of the front wheels, left positive",
                  [](const Frame& f) { return f.asked.steer; }),
    field<double>("steer_applied_rad", "", [](const Frame& f) { return f.applied.steer; }),
    field<double>("throttle_asked", "[-1, 1], negative brakes",
                  [](const Frame& f) { return f.asked.throttle; }),
    field<double>("throttle_applied", "", [](const Frame& f) { return f.applied.throttle; }),
};

constexpr auto kRungNames = capital_names("RUNG_", controller::kRungWords);
constexpr auto kRungs = constants(kRungNames, controller::kRungWords);
constexpr auto kReasonNames = capital_names("REASON_", controller::kGuardReasonWords);
constexpr auto kGuardReasons = constants(kReasonNames, controller::kGuardReasonWords);
constexpr auto kStatusNames = capital_names("STATUS_", solver::kSolveStatusWords);
constexpr auto kStatuses = constants(kStatusNames, solver::kSolveStatusWords);

constexpr std::array kStep{
    field<std::uint8_t>(
        "rung", "", [](const Frame& f) { return f.guard.rung; }, kRungs),
    field<std::int8_t>(
        "solve_status", "", [](const Frame& f) { return solve(f).status; }, kStatuses),
    field<bool>("is_gated", "the command gate had to change the command",
                [](const Frame& f) { return f.guard.gated; }),
    field<std::uint8_t>(
        "guard_reason", "", [](const Frame& f) { return f.guard.reason; }, kGuardReasons),
    field<double>("stop_edge_m",
                  "of the stop at hand, least distance of a tyre to the known edge; NaN: no stop",
                  [](const Frame& f) { return f.guard.stop_edge; }),
    field<double>("stop_distance_m", "of the stop at hand, to standstill; NaN: no stop",
                  [](const Frame& f) { return f.guard.stop_distance; }),
    field<bool>("has_map", "the lap is closed in the controller's memory",
                [](const Frame& f) { return report(f).has_map; }),
    field<std::uint32_t>("iterations", "of the outer (SQP) loop",
                         [](const Frame& f) { return solve(f).iterations; }),
    field<std::uint32_t>("sweeps", "Riccati sweeps, changes of the active set included",
                         [](const Frame& f) { return solve(f).sweeps; }),
    field<double>("cost", "of the plan", [](const Frame& f) { return solve(f).cost; }),
    field<double>("step_time_us", "of the whole control step, wall clock",
                  [](const Frame& f) { return 1e6 * f.step_time; }),
    field<double>("delay_s", "compensated: from measurement to actuation",
                  [](const Frame& f) { return report(f).delay; }),
    field<double>("speed_reference_mps", "wanted where the command acts",
                  [](const Frame& f) { return report(f).speed_reference; }),
    field<double>("sight_m", "length of known road ahead", [](const Frame& f) { return report(f).sight; }),
    field<double>("tracked_lateral_error_m", "from the line the controller follows",
                  [](const Frame& f) { return report(f).lateral_error; }),
    field<double>("tracked_heading_error_rad", "yaw minus the direction of that line",
                  [](const Frame& f) { return report(f).heading_error; }),
};

constexpr std::array kSent{
    field<double>("steer_sent_rad", "", [](const Frame& f) { return f.result.command.steer; }),
    field<double>("throttle_sent", "", [](const Frame& f) { return f.result.command.throttle; }),
    field<double>("pace", "run seconds per second of the clock", [](const Frame& f) { return f.pace; }),
    field<bool>("is_manual", "a person drives", [](const Frame& f) { return f.is_manual; }),
};

constexpr auto kLimiterNames = capital_names("SPEED_LIMITER_", road::kSpeedLimiterWords);
constexpr auto kSpeedLimiters = constants(kLimiterNames, road::kSpeedLimiterWords);

constexpr std::array kReasons{
    field<Numbers>("cost_terms", "of the plan, summed over its stages (names: Run.cost_term_names)",
                   [](const Frame& f) { return cost_terms(f); }),
    field<std::uint8_t>(
        "speed_limiter", "what limits the speed of the plan where the command acts",
        [](const Frame& f) { return why(f).speed_limiter; }, kSpeedLimiters),
    field<double>("speed_limit_mps", "what the speed plan allows where the command acts",
                  [](const Frame& f) { return why(f).speed_limit; }),
    field<std::uint32_t>("active_now", "constraints (bits: Run.constraint_names) in the plan's first stage",
                         [](const Frame& f) { return why(f).active_now; }),
    field<std::uint32_t>("active_ahead", "and anywhere in it",
                         [](const Frame& f) { return why(f).active_ahead; }),
};

const controller::LearnedCar& learned(const Frame& frame) { return frame.result.report.learned; }

constexpr std::array kLearned{
    field<double>("learned_delay_s", "by which commands act later than configured",
                  [](const Frame& f) { return learned(f).delay.value; }),
    field<double>("learned_delay_sd_s", "its standard deviation",
                  [](const Frame& f) { return learned(f).delay.deviation; }),
    field<double>("learned_steer_gain", "the wheels turn to gain times command plus offset",
                  [](const Frame& f) { return learned(f).gain.value; }),
    field<double>("learned_steer_gain_sd", "its standard deviation",
                  [](const Frame& f) { return learned(f).gain.deviation; }),
    field<double>("learned_steer_offset_rad", "left positive",
                  [](const Frame& f) { return learned(f).offset.value; }),
    field<double>("learned_steer_offset_sd_rad", "its standard deviation",
                  [](const Frame& f) { return learned(f).offset.deviation; }),
    field<double>("learned_grip", "of the tyres, share of the configured one",
                  [](const Frame& f) { return learned(f).grip.value; }),
    field<double>("learned_grip_sd", "its standard deviation",
                  [](const Frame& f) { return learned(f).grip.deviation; }),
};

constexpr std::array kCar{
    field<double>("front_tire_use", "1 = all of it, more slides",
                  [](const Frame& f) { return f.tire_use[0]; }),
    field<double>("rear_tire_use", "1 = all of it, more slides",
                  [](const Frame& f) { return f.tire_use[1]; }),
    field<std::uint32_t>("active_faults", "bits: Run.fault_names",
                         [](const Frame& f) { return f.active_faults; }),
};

constexpr std::array kSolver{
    field<double>("stationarity", "largest step a projected gradient would still take",
                  [](const Frame& f) { return solve(f).stationarity; }),
    field<double>("violation", "largest violation of a soft constraint",
                  [](const Frame& f) { return solve(f).violation; }),
    field<std::int32_t>("worst_stage", "where it is, -1 nowhere",
                        [](const Frame& f) { return solve(f).worst_stage; }),
    field<std::int32_t>("worst_constraint", "its place in Run.constraint_names, -1 none",
                        [](const Frame& f) { return solve(f).worst_constraint; }),
    field<double>("prediction_error_m", "of the car now from where plans said, one delay and one period ago",
                  [](const Frame& f) { return f.prediction_error; }),
};

constexpr std::array kGroups{
    FrameGroup{"", kTime},
    FrameGroup{"Motion of the centre of mass; map is the world, yaw 0 along its x axis", kMotion},
    FrameGroup{"Input of the controller: the measurement as it came in", kMeasured},
    FrameGroup{"On the road, judged by our simulator, or from what was measured where the track is known; "
               "else not-a-number",
               kRoad},
    FrameGroup{
        "Commands: asked by the controller now, before the gate, and acting on the car after the delay",
        kCommands},
    FrameGroup{"The control step", kStep},
    FrameGroup{"Commands as sent, after the gate", kSent},
    FrameGroup{"Why the controller chose this command", kReasons},
    FrameGroup{"The simulated car: share of its grip that each axle uses; faults that are on", kCar},
    FrameGroup{"How good the answer is", kSolver},
    FrameGroup{"What the run has found out about its car (docs/identification.md); else not-a-number",
               kLearned},
};

}  // namespace

std::span<const FrameGroup> frame_groups() noexcept { return kGroups; }

model::State known_motion(const Frame& frame) noexcept {
  if (frame.has_truth) return frame.truth;
  const model::Measurement& seen = frame.measurement;
  return {.x = seen.x,
          .y = seen.y,
          .psi = seen.psi,
          .vx = seen.speed,
          .vy = kNaN,
          .r = kNaN,
          .steer = seen.steer};
}

}  // namespace chicane::protocol
