// SPDX-License-Identifier: MIT
// Metrics of a run: laps, durations, the summary of the run, the settings of each lap, and the error of
// predictions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/deadline.hpp"
#include "chicane/base/random.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/safety/guard_options.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::telemetry {

/// Text in fixed memory, for handing from thread to thread without allocation. Texts beyond the capacity are
/// cut off: check with fits().
template <std::size_t Capacity>
class ShortText {
 public:
  ShortText() = default;
  template <std::convertible_to<std::string_view> Text>
  ShortText(const Text& text) noexcept {  // NOLINT(google-explicit-constructor): it is a text
    const std::string_view all = text;
    size_ = std::min(all.size(), Capacity);
    std::copy_n(all.begin(), size_, bytes_.begin());
  }
  [[nodiscard]] static constexpr bool fits(std::string_view text) noexcept { return text.size() <= Capacity; }
  [[nodiscard]] std::string_view view() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<char, Capacity> bytes_{};
  std::size_t size_ = 0;
};

/// Change of a setting during a run (live/live_settings.hpp).
struct Change {
  std::uint64_t cycle = 0;   ///< first control cycle after the change
  double time = 0.0;         ///< time of the run [s]
  ShortText<64> name;        ///< schema key, "run.pace", "manual.…" or "fault.…"
  ShortText<256> value;      ///< text as --set takes it: reads back into the same bits
  bool starts_anew = false;  ///< another run begins with it: all earlier changes are void
};

/// State of the world after one physics step. Exact extremes need every step, not every control cycle.
struct PhysicsSample {
  double step = 0.0;                  ///< length of the step [s]
  model::State state;                 ///< state at the end of the step
  double lateral_acceleration = 0.0;  ///< [m/s²], left positive
  double lateral_error = 0.0;         ///< offset from the track's line [m], left positive
  double edge_distance = 0.0;         ///< gap of outermost contact patch to edge [m], negative = off the road
  bool is_off_track = false;          ///< any contact patch beyond the drivable surface
};

/// Value of numbers that were not measured.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// One lap, or any stretch of a run, in numbers. NaN where nothing was measured.
struct LapSummary {
  double lap_time = 0.0;                                                ///< [s]
  double mean_speed = 0.0;                                              ///< mean over time [m/s]
  double top_speed = 0.0;                                               ///< [m/s]
  double rms_lateral_error = 0.0;                                       ///< root mean square over time [m]
  double max_abs_lateral_error = 0.0;                                   ///< [m]
  double min_edge_distance = std::numeric_limits<double>::quiet_NaN();  ///< signed, outermost tyre [m]
  double max_lateral_acceleration = 0.0;                                ///< magnitude [m/s²]
  double steering_rate_rms = 0.0;  ///< road wheel, from control cycle to control cycle [rad/s]
  std::array<double, 3> sector_times = {kNotMeasured, kNotMeasured, kNotMeasured};  ///< thirds of a lap [s]
  /// Lap time over the physical limit's, minus one; none if the limit is unknown.
  std::optional<double> gap_to_limit{};
  std::array<double, 3> sector_gaps = {kNotMeasured, kNotMeasured, kNotMeasured};  ///< the same for thirds
  /// Times of RunSummary::corners, each with half of the straights beside it [s]; empty if not measured.
  std::vector<double> corner_times{};
};

/// Percentiles of durations [s]; bins are at most 6.3 % wide (base/deadline.hpp), `max` is exact.
struct TimeSummary {
  double p50 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
};

/// Summary of one run. run::Account fills in names, request and end; Metrics the measured numbers.
struct RunSummary {
  std::string track, car, controller, preset;  ///< names of the parts
  std::optional<safety::GuardOptions> guard;   ///< none if another program drives
  std::vector<std::string> notices;            ///< notices of the scenario, a sentence each
  std::uint64_t seed = 0;
  double latency = 0.0;    ///< actuation delay of the plant [s]
  int laps_wanted = 0;     ///< 0 = until stopped
  bool completed = false;  ///< all wanted laps were driven
  std::string end_reason;  ///< reason of another end, one sentence; empty if completed

  int laps_completed = 0;
  int off_track_events = 0;                  ///< times a contact patch left the drivable surface
  double out_of_track_time = 0.0;            ///< [s]
  double duration = 0.0;                     ///< duration in the run's own time [s]
  double wall_time = 0.0;                    ///< duration by the machine's clock [s]; filled by the loop
  std::vector<LapSummary> laps;              ///< completed laps
  std::vector<road::Corner> corners;         ///< corners of the track, in the order of a lap
  std::optional<lap_time::LapTimes> limit;   ///< fastest lap that the car can drive; none if unknown
  std::vector<double> planned_corner_times;  ///< corner times of the last planned lap [s]; empty: none
  std::string why_no_limit;  ///< reason for an unknown limit; empty with one, or if none was requested
  std::vector<lap_time::LapWithout> without;  ///< laps that explain the gap to the limit; empty: not driven
  LapSummary total;              ///< the whole run with its unfinished lap; lap_time is the run's duration
  TimeSummary step_time;         ///< durations of control steps, wall clock
  TimeSummary solve_time;        ///< durations of their optimisations, wall clock
  std::uint64_t cycles = 0;      ///< control steps
  double mean_iterations = 0.0;  ///< mean iterations of the solver in a control step
  std::uint64_t not_usable = 0;  ///< optimisations without a usable result
  std::uint64_t fallbacks = 0;   ///< steps whose command came from a rung below the controller
  /// Control steps by reason of the guard (controller::GuardReason); [0]: without a finding.
  std::array<std::uint64_t, controller::kGuardReasonCount> guard_reasons{};
  controller::LearnedCar learned;        ///< learned values of the last step
  std::uint64_t gate_interventions = 0;  ///< commands that the gate had to change
  std::uint64_t deadline_misses = 0;     ///< steps that took longer than the control period
  /// Hash of all plant states and commands: equal for equal scenarios and seeds, on every machine.
  std::uint64_t state_hash = 0;
};

/// Whether every wanted lap is completed and no tyre left the road. A run until stopped wants no number of
/// laps.
[[nodiscard]] inline bool completed_on_road(const RunSummary& run) noexcept {
  return (run.completed || run.laps_wanted == 0) && run.off_track_events == 0;
}

/// Compares a run with the limit: its times, and the gap of each lap (docs/limit.md, eq. 10) from number
/// `first_lap`, counted from 1, on.
void compare_with_limit(RunSummary& run, const lap_time::LapTimes& limit, int first_lap = 1);

/// Counts and measures a run step by step. No allocation after construction; one thread.
///
/// Call add_physics() after each physics step, and add() in each control cycle. For a car of another program
/// (frames without truth) add() also measures speed and lateral error, and on a known track the distance to
/// the edge, from the measurements of the controller.
class Metrics {
 public:
  /// Keeps up to `lap_capacity` laps (more are only counted), with the times of `corners` corners each.
  /// `deadline` [s]: longer steps are misses.
  Metrics(int lap_capacity, double deadline, std::size_t corners = 0);

  void add_physics(const PhysicsSample& sample) noexcept;
  void add(const Frame& frame) noexcept;
  /// Ends the running lap. All times [s] may be interpolated between physics steps. Corner times are left out
  /// unless there are as many as the constructor was given.
  void lap_completed(double lap_time, const std::array<double, 3>& sector_times = LapSummary{}.sector_times,
                     std::span<const double> corner_times = {}) noexcept;

  /// Drops the running lap, and begins another one.
  void drop_lap() noexcept { lap_ = {}; }

  [[nodiscard]] int laps_completed() const noexcept { return laps_completed_; }
  /// The last completed lap; zeros before the first.
  [[nodiscard]] const LapSummary& last_lap() const noexcept { return last_lap_; }
  [[nodiscard]] int off_track_events() const noexcept { return off_track_events_; }
  [[nodiscard]] std::uint64_t state_hash() const noexcept { return hash_.value(); }
  /// Summary of the run so far; names, request and end keep their defaults. Allocates.
  [[nodiscard]] RunSummary summary() const;

 private:
  /// Adds `step` [s] at a distance to the edge [m].
  void judge(double step, double edge_distance, bool is_off_track) noexcept;

  /// Sums and extremes over a stretch of time: a lap, or the run.
  struct Stretch {
    double time = 0.0;                ///< duration [s]
    double speed_time = 0.0;          ///< ∫ v dt [m]
    double error_squared_time = 0.0;  ///< ∫ e² dt, e: lateral error [m² s]
    double top_speed = 0.0;           ///< [m/s]
    double max_abs_error = 0.0;       ///< largest lateral error [m]
    double min_edge_distance = std::numeric_limits<double>::infinity();  ///< [m]
    double max_lateral_acceleration = 0.0;                               ///< magnitude [m/s²]
    double rate_time = 0.0;          ///< duration with a steering rate [s]
    double rate_squared_time = 0.0;  ///< ∫ δ'² dt [rad²/s]
    /// Adds `dt` [s] at a speed [m/s] and lateral error [m].
    void add(double dt, double speed, double error) noexcept;
    /// Adds `dt` [s] at a steering rate [rad/s].
    void add_rate(double dt, double rate) noexcept;
    /// Summary of the stretch as a lap of `lap_time` [s].
    [[nodiscard]] LapSummary summary(double lap_time) const noexcept;
  };

  std::vector<LapSummary> laps_;        ///< laps without corner times
  std::size_t corners_;                 ///< corners of a lap
  std::vector<double> corner_times_{};  ///< corner times of all laps, one lap after the other [s]
  LapSummary last_lap_;                 ///< last completed lap
  double deadline_;                     ///< longest control step that is no miss [s]
  Stretch lap_, total_;                 ///< running lap, and whole run
  Durations step_times_, solve_times_;  ///< durations of control steps and optimisations
  Fnv hash_;                            ///< hash of states and commands
  int laps_completed_ = 0;
  int off_track_events_ = 0;        ///< times that the car left the road
  bool is_off_track_ = false;       ///< the car is off the road now
  double out_of_track_time_ = 0.0;  ///< time off the road [s]
  std::array<std::uint64_t, controller::kGuardReasonCount> guard_reasons_{};
  std::uint64_t cycles_ = 0, iterations_ = 0, not_usable_ = 0, fallbacks_ = 0, gated_ = 0,
                deadline_misses_ = 0;
  controller::LearnedCar learned_;  ///< learned values of the last step
  double last_time_ = 0.0;          ///< time of the last control cycle [s]
  double last_steer_ = 0.0;         ///< steering angle in it [rad]
};

/// Settings and faults of a lap.
struct LapSetup {
  /// Names of the settings that changed since the run began, also of those that were changed back, and their
  /// values at the end of the lap as --set takes them. Both have the same length.
  std::vector<std::string> names{}, values{};
  bool is_mixed = false;              ///< a setting changed during the lap
  double by_hand_share = 0.0;         ///< share of the lap driven by a person, in [0, 1]
  std::vector<std::string> faults{};  ///< names of the faults that acted in the lap, without "fault."
};

/// Changes of a run, from which the settings of each lap follow. Allocates: for threads that write or send.
/// Pace and the controls of a person are no settings. If there are very many changes, the older ones are
/// summarised: settings of the newest laps stay exact, those of old laps are lost.
class LapLedger {
 public:
  static constexpr std::size_t kMostKept = 1024;  ///< changes kept one by one; chosen

  /// Begins another run: drops all changes.
  void begin() { log_.clear(); }
  /// Restarts the run: settings and driver stay, faults end.
  void restart();
  /// Adds a change, in the order of time. One that `starts_anew` begins another run.
  void add(const Change& change);

  /// Setup of a lap that ended at `end` [s] of the run and took `lap_time` [s].
  [[nodiscard]] LapSetup setup(double end, double lap_time) const;

 private:
  static constexpr double kBefore = -std::numeric_limits<double>::infinity();  ///< time of summarised changes
  /// Change that is kept.
  struct Noted {
    double time = kBefore;  ///< [s]
    std::string name{}, value{};
  };
  /// Summarises the oldest `count` changes: keeps the last value of each name.
  void fold(std::size_t count);

  std::vector<Noted> log_;  ///< changes by rising time
};

/// Compares plans with the motion that followed. Keeps of each plan the position one control period after its
/// beginning, which is one delay and one period after the measurement. Between two such positions the
/// prediction is a straight line (a sagitta of 4 mm at 30 m/s on a radius of 50 m). No allocation; one
/// thread.
class PredictionCheck {
 public:
  void reset() noexcept { count_ = 0; }

  /// Adds the plan of a cycle; `period`: control period [s]. An empty plan drops all predictions.
  void add(const controller::Plan& plan, double period) noexcept {
    if (plan.size < 2) return reset();
    const double time = plan.points[0].time + period;
    if (count_ > 0 && !(time > at(count_ - 1).time)) reset();
    int i = 0;
    while (i + 2 < plan.size && point(plan, i + 1).time < time) ++i;
    const controller::PlanPoint& from = point(plan, i);
    const controller::PlanPoint& to = point(plan, i + 1);
    const double share = (time - from.time) / (to.time - from.time);
    if (count_ == kCapacity) {
      first_ = (first_ + 1) % kCapacity;
      --count_;
    }
    at(count_++) = {time, {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)}};
  }

  /// Distance of `position` from the prediction for `time` [s], in [m]; NaN without a prediction. Times do
  /// not decrease between resets.
  [[nodiscard]] double error(double time, const Vec2& position) noexcept {
    constexpr double kRounding = 1e-9;  // [s] rounding of times that are sums of step lengths
    while (count_ > 1 && at(1).time <= time + kRounding) {
      first_ = (first_ + 1) % kCapacity;
      --count_;
    }
    if (count_ < 2 || time < at(0).time - kRounding) return std::numeric_limits<double>::quiet_NaN();
    const double share = (time - at(0).time) / (at(1).time - at(0).time);
    return (at(0).place + share * (at(1).place - at(0).place) - position).norm();
  }

 private:
  /// Predicted position in W [m] at a time [s].
  struct Prediction {
    double time = 0.0;
    Vec2 place{};
  };
  static constexpr std::size_t kCapacity = 256;  ///< chosen: beyond a delay of 0.5 s at a period of 5 ms

  [[nodiscard]] static const controller::PlanPoint& point(const controller::Plan& plan, int i) noexcept {
    return plan.points[static_cast<std::size_t>(i)];
  }
  /// Prediction number `i`, the oldest first.
  [[nodiscard]] Prediction& at(std::size_t i) noexcept { return predictions_[(first_ + i) % kCapacity]; }

  std::array<Prediction, kCapacity> predictions_{};  ///< ring of predictions
  std::size_t first_ = 0;                            ///< index of the oldest one
  std::size_t count_ = 0;                            ///< predictions in the ring
};

}  // namespace chicane::telemetry
