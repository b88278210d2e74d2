// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/world.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Terms of a run that its account needs from the start.
struct AccountTerms {
  std::string track{}, car{}, controller{}, preset{};  ///< names in the report
  std::vector<road::Corner> corners{};                 ///< corners of the track
  std::vector<std::string> notices{};                  ///< scenario.notices
  std::uint64_t seed = 0;
  double scale = 1.0;                           ///< scale of distances: size of the car over full size
  std::optional<safety::GuardOptions> guard{};  ///< none where another program drives
  double latency = 0.0;                         ///< [s]
  int laps = 0;                                 ///< wanted; 0: until stopped, whatever happens to the car
  double time_limit = 0.0;                      ///< [s]; 0: 10 min per lap, none without a number of laps
  double full_brake = 1.0;                      ///< VehicleParams::brake_throttle_limit
  std::string_view remedy = telemetry::kKeysRemedy;  ///< SituationTerms::remedy
  double step_deadline = 0.0;  ///< control steps that take longer are counted as misses [s]
};
/// Terms of a run in which `scenario.controller` drives on a track; null if the road is not known.
[[nodiscard]] AccountTerms terms_of(const scenario::Scenario& scenario, const road::Track* track);

/// The account of a run: laps and sectors, metrics, when it is over and why, and the report. The one place
/// where that is kept: `drive`, `serve`, `simulate` and branches of recordings all use it, with a plant of
/// ours (add_physics) or with a car that is only seen (add_sighting).
///
/// A run is over when the laps that were asked for are driven or an open road is finished (its one lap), when
/// the time limit is reached, or when the car is lost: more than kLostDistance from the line for kLostTime
/// without coming nearer. A run without a number of laps ends at a time limit that was given, or not at all;
/// a car that a person drives is never lost.
///
/// No allocation but in the constructor, restart() and summary(). One thread.
class Account {
 public:
  static constexpr double kLostDistance = 25.0;  ///< [m]
  static constexpr double kLostTime = 30.0;      ///< [s]
  static constexpr double kNearer = 1.0;         ///< [m] that count as coming nearer
  static constexpr double kStoodTime = 3.0;      ///< [s] of standing that a time limit's sentence mentions
  static constexpr double kTimePerLap = 600.0;   ///< [s] where no time limit was given
  static constexpr int kLapsRemembered = 1000;   ///< one by one, beyond those asked for

  explicit Account(AccountTerms terms);

  /// Restarts with the same terms: everything is counted from zero.
  void restart();
  /// Continues the same run with another car, or with the same one from another place: counts stay, the
  /// running lap does not count.
  void resume() noexcept;

  /// Other laps, time limit and latency are asked for from now on; the names stay. Does not allocate.
  void set_terms(int laps, double time_limit, double latency) noexcept;

  /// Adds a physics step of our plant. `is_manual`: a person drives.
  void add_physics(const sim::World& world, bool is_manual) noexcept;
  /// Adds a sighting of a car that another program simulates. `corner_times`: Judge::last_corner_times().
  void add_sighting(const sim::WorldState& car, std::span<const double> corner_times = {}) noexcept;
  /// Adds a control cycle: counts it, and replaces the previous cycle's situation in the frame by its own.
  void add(telemetry::Frame& frame) noexcept;

  /// The lap that was completed last; lap 0: none yet.
  [[nodiscard]] const telemetry::CompletedLap& completed_lap() const noexcept { return completed_lap_; }
  /// The same, once for each lap; none when it was taken already.
  [[nodiscard]] std::optional<telemetry::CompletedLap> take_lap() noexcept;
  [[nodiscard]] int laps_completed() const noexcept { return metrics_.laps_completed(); }

  [[nodiscard]] bool is_over() const noexcept { return is_over_; }
  [[nodiscard]] bool is_lost() const noexcept { return lost_for_ > kLostTime; }
  /// Removes the limits on laps and time: from now on only a lost car ends the run.
  void drive_on() noexcept;

  /// `duration`: of the run [s]; without it the measured one. Allocates.
  [[nodiscard]] telemetry::RunSummary summary(std::optional<double> duration = std::nullopt) const;

 private:
  void count_laps(const sim::WorldState& car, std::span<const double> corner_times) noexcept;
  void look_for_end(const sim::WorldState& car, double time, double step, bool is_manual) noexcept;
  [[nodiscard]] double time_limit() const noexcept;

  AccountTerms terms_;
  telemetry::Metrics metrics_;
  telemetry::CompletedLap completed_lap_;
  bool has_new_lap_ = false;
  int laps_seen_ = 0;                                         ///< judge's laps since restart() or resume()
  double nearest_ = std::numeric_limits<double>::infinity();  ///< least distance while far from the line [m]
  double lost_for_ = 0.0;                                     ///< time far and not coming nearer [s]
  double edge_distance_ = 0.0;                                ///< edge distance of our plant [m]
  double stood_for_ = 0.0;                                    ///< time at standstill so far [s]
  bool is_endless_ = false;
  bool is_over_ = false;
  bool has_finished_ = false;  ///< an open road
  const char* end_reason_ = "";
};

/// Times the laps of a car on a road that is not known: its start line is the straight line across the car
/// where it was first seen, kReach to each side. A lap counts when the car crosses that line again in the
/// same direction, after kLeast of way and 90 % of the first lap's; crossing back and forth counts for
/// nothing. What would need the road stays unknown: place, edges, sectors.
///
/// Between two sightings the car is taken to go evenly. Allocates nothing, cannot fail. One thread.
class LapLearner {
 public:
  static constexpr double kReach = 15.0;  ///< [m]
  static constexpr double kLeast = 50.0;  ///< way of a lap [m]

  /// A new run from wherever the car is seen next.
  void reset() noexcept;
  /// Time rises from sighting to sighting; `speed` [m/s] distinguishes a car that drives from one that was
  /// moved: the latter's running lap begins at its place.
  void see(double time, const model::Pose& car, double speed) noexcept;

  /// Laps and their times; all else at its default.
  [[nodiscard]] const sim::WorldState& state() const noexcept { return state_; }

 private:
  void start(double time, const model::Pose& car) noexcept;
  void cross_line(double crossing) noexcept;
  void count_lap(double crossing) noexcept;

  sim::WorldState state_;
  bool has_line_ = false;
  Vec2 line_{0.0, 0.0};
  Vec2 direction_{1.0, 0.0};  ///< direction in which the line is crossed
  Vec2 last_{0.0, 0.0};
  int backward_ = 0;         ///< crossings that have to be made up for
  double lap_start_ = 0.0;   ///< [s]
  double driven_ = 0.0;      ///< distance since the line was crossed [m]
  double lap_length_ = 0.0;  ///< length of the first lap [m]; 0: none yet
};

/// Keeps the account of a run whose car is simulated by another program, over all its connections: counts,
/// and where the road is known judges the car by the measured positions and by the car as it is
/// assumed, as sim::World does with a plant of ours. Where it is not, laps are learnt from where the
/// car has been (LapLearner). Lap times are as good as the clock that telemetry is received by: some
/// milliseconds on one machine. One thread.
class Roadside {
 public:
  /// `track` may be null: then laps are timed, and nothing is judged. It outlives this. `remedy`:
  /// SituationTerms::remedy.
  Roadside(const road::Track* track, const scenario::Scenario& scenario,
           std::string_view remedy = telemetry::kSimulatorRemedy);

  /// Continues with another car, or the same one from another place: the running lap does not count, the rest
  /// stays.
  void resume() noexcept;
  /// Drops the track and all judgements by it: the car drives on another road than configured.
  void forget_track();
  /// Writes place, edges and laps by the measurement into the frame, and counts it. Allocates nothing.
  void judge(telemetry::Frame& frame) noexcept;
  /// The lap that was just completed, once.
  [[nodiscard]] std::optional<telemetry::CompletedLap> take_lap() noexcept { return account_.take_lap(); }
  [[nodiscard]] telemetry::RunSummary summary() const;

 private:
  void look(telemetry::Frame& frame) noexcept;
  void learn(telemetry::Frame& frame) noexcept;

  scenario::Scenario scenario_;
  std::string_view remedy_;          ///< SituationTerms::remedy
  std::optional<sim::Judge> judge_;  ///< none where the road is not known
  LapLearner learner_;               ///< laps without a known road
  Account account_;
  int events_before_ = 0;  ///< off the road, before this car
  bool has_seen_ = false;
};

}  // namespace chicane::run
