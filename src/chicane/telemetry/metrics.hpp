// SPDX-License-Identifier: MIT
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

/// A text in fixed memory, so that it can be handed from thread to thread without allocation. What does not
/// fit is cut off: ask `fits` before.
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

/// One setting that changed while a run went on (live/live_settings.hpp).
struct Change {
  std::uint64_t cycle = 0;   ///< the first control cycle that follows it
  double time = 0.0;         ///< time of the run [s]
  ShortText<64> name;        ///< schema key, "run.pace", "manual.…" or "fault.…"
  ShortText<256> value;      ///< text as --set takes it: reads back into the same bits
  bool starts_anew = false;  ///< the run restarted with it: all earlier changes are void
};

/// State of the world after one physics step: exact extremes need every step, not every control cycle.
struct PhysicsSample {
  double step = 0.0;                  ///< length of the step [s]
  model::State state;                 ///< state at its end
  double lateral_acceleration = 0.0;  ///< [m/s²], left positive
  double lateral_error = 0.0;         ///< offset from the track's line [m], left positive
  double edge_distance = 0.0;         ///< gap of outermost contact patch to edge [m], negative = off the road
  bool is_off_track = false;          ///< any contact patch beyond the drivable surface
};

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// One lap, or any stretch of a run, in numbers. NaN where nothing was measured.
struct LapSummary {
  double lap_time = 0.0;                                                ///< [s]
  double mean_speed = 0.0;                                              ///< mean over time [m/s]
  double top_speed = 0.0;                                               ///< [m/s]
  double rms_lateral_error = 0.0;                                       ///< mean square over time [m]
  double max_abs_lateral_error = 0.0;                                   ///< [m]
  double min_edge_distance = std::numeric_limits<double>::quiet_NaN();  ///< signed, outermost tyre [m]
  double max_lateral_acceleration = 0.0;                                ///< magnitude [m/s²]
  double steering_rate_rms = 0.0;  ///< road wheel, from control cycle to control cycle [rad/s]
  std::array<double, 3> sector_times = {kNotMeasured, kNotMeasured, kNotMeasured};  ///< thirds of a lap [s]
  std::optional<double>
      gap_to_limit{};  ///< lap time over the physical limit's, minus one; none when not computed
  std::array<double, 3> sector_gaps = {kNotMeasured, kNotMeasured, kNotMeasured};  ///< gaps of the thirds
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

/// Summary by which one run is judged. The run time fills in the request (track to laps_wanted, completed);
/// Metrics the rest.
struct RunSummary {
  std::string track, car, controller, preset;
  std::optional<safety::GuardOptions> guard;  ///< none where another program drives
  std::vector<std::string> notices;           ///< notices of the scenario, a sentence each
  std::uint64_t seed = 0;
  double latency = 0.0;    ///< actuation delay of the plant [s]
  int laps_wanted = 0;     ///< 0 = until stopped
  bool completed = false;  ///< all wanted laps were driven
  std::string end_reason;  ///< reason of another end, one sentence; empty if completed

  int laps_completed = 0;
  int off_track_events = 0;                  ///< times a contact patch left the drivable surface
  double out_of_track_time = 0.0;            ///< [s]
  double duration = 0.0;                     ///< duration in the run's own time [s]
  double wall_time = 0.0;                    ///< duration on the wall's clock [s]; filled by the run time
  std::vector<LapSummary> laps;              ///< completed laps
  std::vector<road::Corner> corners;         ///< corners of the track, in the order of a lap
  std::optional<lap_time::LapTimes> limit;   ///< the fastest lap the car can drive; none when not computed
  std::vector<double> planned_corner_times;  ///< times of the plan raced by last [s]; empty: none
  std::string why_no_limit;  ///< reason in one sentence; empty with a limit, or if none was asked for
  std::vector<lap_time::LapWithout> without;  ///< laps that explain the gap to it; empty: not driven
  LapSummary total;          ///< the whole run, unfinished lap included; lap_time is its duration
  TimeSummary step_time;     ///< whole control steps, wall clock
  TimeSummary solve_time;    ///< optimisation in them, wall clock
  std::uint64_t cycles = 0;  ///< control steps
  double mean_iterations = 0.0;
  std::uint64_t not_usable = 0;  ///< solves whose answer must not be used
  std::uint64_t fallbacks = 0;   ///< steps whose command came from a rung below the controller
  /// Steps in which the guard found something, by controller::GuardReason; [0]: nothing.
  std::array<std::uint64_t, controller::kGuardReasonCount> guard_reasons{};
  controller::LearnedCar learned;  ///< learned values of the last step
  std::uint64_t gate_interventions = 0;
  std::uint64_t deadline_misses = 0;  ///< steps that took longer than the control period
  std::uint64_t state_hash =
      0;  ///< hash of every plant state and command: same scenario and seed, same number, everywhere
};

/// Whether every wanted lap is completed and no tyre left the road. A run until stopped wants no number of
/// laps.
[[nodiscard]] inline bool completed_on_road(const RunSummary& run) noexcept {
  return (run.completed || run.laps_wanted == 0) && run.off_track_events == 0;
}

/// Compares a run with the limit: its times, and the gap of each lap (docs/limit.md, eq. 10) from number
/// `first_lap`, counted from 1, on.
void compare_with_limit(RunSummary& run, const lap_time::LapTimes& limit, int first_lap = 1);

/// Counts and measures a run while it happens. No allocation after construction; one thread.
///
/// Call add_physics() after each physics step and add() once each control cycle. Where the plant is outside
/// (a frame without truth) add() also measures speed and lateral error, and where a judge knows the track the
/// distance to the edge, from the controller's measurements.
class Metrics {
 public:
  /// Keeps up to `lap_capacity` laps (more are only counted), with the times of `corners` corners each.
  /// `deadline` [s]: longer steps are misses.
  Metrics(int lap_capacity, double deadline, std::size_t corners = 0);

  void add_physics(const PhysicsSample& sample) noexcept;
  void add(const Frame& frame) noexcept;
  /// The running lap ended; `lap_time` [s] may be interpolated between physics steps, as may its thirds and
  /// corners. Times of another number of corners than the constructor was given are left out.
  void lap_completed(double lap_time, const std::array<double, 3>& sector_times = LapSummary{}.sector_times,
                     std::span<const double> corner_times = {}) noexcept;

  /// The running lap does not count: another one begins.
  void drop_lap() noexcept { lap_ = {}; }

  [[nodiscard]] int laps_completed() const noexcept { return laps_completed_; }
  /// The last completed lap; zeros before the first.
  [[nodiscard]] const LapSummary& last_lap() const noexcept { return last_lap_; }
  [[nodiscard]] int off_track_events() const noexcept { return off_track_events_; }
  [[nodiscard]] std::uint64_t state_hash() const noexcept { return hash_.value(); }
  /// Summary of the run so far; fields of the run time (names, seed, completed) keep their defaults.
  /// Allocates.
  [[nodiscard]] RunSummary summary() const;

 private:
  void judge(double step, double edge_distance, bool is_off_track) noexcept;

  /// Sums over a stretch of time.
  struct Stretch {
    double time = 0.0;
    double speed_time = 0.0;          // ∫ v dt
    double error_squared_time = 0.0;  // ∫ e² dt
    double top_speed = 0.0;
    double max_abs_error = 0.0;
    double min_edge_distance = std::numeric_limits<double>::infinity();
    double max_lateral_acceleration = 0.0;
    double rate_time = 0.0;
    double rate_squared_time = 0.0;  // ∫ δ'² dt
    void add(double dt, double speed, double error) noexcept;
    void add_rate(double dt, double rate) noexcept;
    [[nodiscard]] LapSummary summary(double lap_time) const noexcept;
  };

  std::vector<LapSummary> laps_;  ///< laps without corner times
  std::size_t corners_;
  std::vector<double> corner_times_{};  ///< times of all laps, one after the other [s]
  LapSummary last_lap_;
  double deadline_;
  Stretch lap_, total_;
  Durations step_times_, solve_times_;
  Fnv hash_;
  int laps_completed_ = 0;
  int off_track_events_ = 0;
  bool is_off_track_ = false;
  double out_of_track_time_ = 0.0;
  std::array<std::uint64_t, controller::kGuardReasonCount> guard_reasons_{};
  std::uint64_t cycles_ = 0, iterations_ = 0, not_usable_ = 0, fallbacks_ = 0, gated_ = 0,
                deadline_misses_ = 0;
  controller::LearnedCar learned_;
  double last_time_ = 0.0;
  double last_steer_ = 0.0;
};

/// Settings and faults of a lap.
struct LapSetup {
  /// Settings that were changed since the run began, as they were at the end of the lap, by name; also those
  /// that were changed back. `values` as --set takes them, of the same length.
  std::vector<std::string> names{}, values{};
  bool is_mixed = false;              ///< one of them changed while the lap was driven
  double by_hand_share = 0.0;         ///< share of its time driven by a person, in [0, 1]
  std::vector<std::string> faults{};  ///< faults that acted in it, without "fault.", by name
};

/// Keeps the changes of a run, so that each lap can be reported with its settings. For threads that write
/// or send: it allocates. Pace and a person's hands are no settings. Of very many changes the older ones are
/// known by their outcome only: laps of long ago cannot be asked for, the newest always.
class LapLedger {
 public:
  static constexpr std::size_t kMostKept = 1024;  ///< changes, one by one

  /// Begins another run with other choices: all changes are dropped.
  void begin() { log_.clear(); }
  /// Restarts the same run: settings and driver stay, faults end.
  void restart();
  /// Adds a change, in the order of time. One that `starts_anew` begins another run.
  void add(const Change& change);

  /// Setup of a lap that ended at `end` [s] of the run and took `lap_time` [s].
  [[nodiscard]] LapSetup setup(double end, double lap_time) const;

 private:
  static constexpr double kBefore = -std::numeric_limits<double>::infinity();
  struct Noted {
    double time = kBefore;  ///< [s]
    std::string name{}, value{};
  };
  void fold(std::size_t count);

  std::vector<Noted> log_;
};

/// Compares plans with the motion that followed: of every plan it keeps where the car is to be one control
/// period after the plan's beginning, that is one delay and one period after the measurement. Between two
/// such places the predicted position is on the straight line (a sagitta of 4 mm at 30 m/s on a radius of 50
/// m). No allocation; one thread.
class PredictionCheck {
 public:
  void reset() noexcept { count_ = 0; }

  /// A plan of this cycle. An empty one discards the predictions before it.
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

  /// Distance of `position` at `time` [s] from the one predicted for it [m]; NaN when there is none. Times do
  /// not decrease between resets.
  [[nodiscard]] double error(double time, const Vec2& position) noexcept {
    constexpr double kRounding = 1e-9;  // sums of step lengths round
    while (count_ > 1 && at(1).time <= time + kRounding) {
      first_ = (first_ + 1) % kCapacity;
      --count_;
    }
    if (count_ < 2 || time < at(0).time - kRounding) return std::numeric_limits<double>::quiet_NaN();
    const double share = (time - at(0).time) / (at(1).time - at(0).time);
    return (at(0).place + share * (at(1).place - at(0).place) - position).norm();
  }

 private:
  struct Prediction {
    double time = 0.0;
    Vec2 place{};
  };
  static constexpr std::size_t kCapacity = 256;  // delays up to 0.5 s at periods down to 5 ms

  [[nodiscard]] static const controller::PlanPoint& point(const controller::Plan& plan, int i) noexcept {
    return plan.points[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] Prediction& at(std::size_t i) noexcept { return predictions_[(first_ + i) % kCapacity]; }

  std::array<Prediction, kCapacity> predictions_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace chicane::telemetry
