// SPDX-License-Identifier: MIT
// Account of a run: laps, metrics, the reason of its end and the report, for a simulated car (Account) and
// for a car that another program simulates (Roadside, LapLearner).
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
  int laps = 0;                                 ///< laps to drive; 0: until stopped, even with a lost car
  double time_limit = 0.0;                      ///< [s]; 0: 10 min per lap, none without a number of laps
  double full_brake = 1.0;                      ///< VehicleParams::brake_throttle_limit
  std::string_view remedy = telemetry::kKeysRemedy;  ///< SituationTerms::remedy
  double step_deadline = 0.0;  ///< control steps that take longer are counted as misses [s]
};
/// Terms of a run in which `scenario.controller` drives on a track; null if the road is not known.
[[nodiscard]] AccountTerms terms_of(const scenario::Scenario& scenario, const road::Track* track);

/// Account of a run: laps and sectors, metrics, the reason of its end, and the report. Shared by `drive`,
/// `serve`, `simulate` and branches of recordings. A simulated car is counted by add_physics(), a car of
/// another program by add_sighting().
///
/// A run is over when its laps are driven, when an open road is finished (one lap), at the time limit, or
/// when the car is lost: more than kLostDistance from the line for kLostTime without coming nearer. A run
/// without a number of laps ends at its time limit only, if it has one. A car that a person drives is never
/// lost.
///
/// No allocation but in the constructor, restart() and summary(). One thread.
class Account {
 public:
  // Chosen. The two distances hold in full size; a model car's are scaled by AccountTerms::scale.
  static constexpr double kLostDistance =
      25.0;                                  ///< distance from the line beyond which a car may be lost [m]
  static constexpr double kLostTime = 30.0;  ///< time beyond that distance after which a car is lost [s]
  static constexpr double kNearer = 1.0;     ///< least decrease of the distance that restarts kLostTime [m]
  static constexpr double kStoodTime = 3.0;  ///< least standstill that the reason of a time limit reports [s]
  static constexpr double kTimePerLap = 600.0;  ///< time limit for each lap of a run without a given one [s]
  static constexpr int kLapsRemembered = 1000;  ///< laps kept one by one, if fewer are to be driven

  explicit Account(AccountTerms terms);

  /// Restarts with the same terms: everything is counted from zero.
  void restart();
  /// Continues the run with another car, or with the same car at another place. Counts stay; the running lap
  /// does not count.
  void resume() noexcept;

  /// Replaces number of laps, time limit [s] and latency [s]. Does not allocate.
  void set_terms(int laps, double time_limit, double latency) noexcept;

  /// Adds a physics step of our plant. `is_manual`: a person drives.
  void add_physics(const sim::World& world, bool is_manual) noexcept;
  /// Adds a sighting of a car that another program simulates: counts its laps. `corner_times`:
  /// Judge::last_corner_times().
  void add_sighting(const sim::WorldState& car, std::span<const double> corner_times = {}) noexcept;
  /// Adds a control cycle. Replaces the previous cycle's situation in `frame` by this cycle's.
  void add(telemetry::Frame& frame) noexcept;

  /// Lap that was completed last; number 0: none yet.
  [[nodiscard]] const telemetry::CompletedLap& completed_lap() const noexcept { return completed_lap_; }
  /// Newest completed lap, returned once; none if it was returned before.
  [[nodiscard]] std::optional<telemetry::CompletedLap> take_lap() noexcept;
  [[nodiscard]] int laps_completed() const noexcept { return metrics_.laps_completed(); }

  [[nodiscard]] bool is_over() const noexcept { return is_over_; }
  [[nodiscard]] bool is_lost() const noexcept { return lost_for_ > kLostTime; }
  /// Removes the limits on laps and time: from now on only a lost car ends the run.
  void drive_on() noexcept;

  /// Report of the run. `duration` of the run [s] replaces the measured one. Allocates.
  [[nodiscard]] telemetry::RunSummary summary(std::optional<double> duration = std::nullopt) const;

 private:
  /// Ends the run if one of its conditions holds at `time` [s]. `step`: length of the physics step [s].
  void look_for_end(const sim::WorldState& car, double time, double step, bool is_manual) noexcept;
  /// Time at which the run ends [s]; infinite: never.
  [[nodiscard]] double time_limit() const noexcept;

  AccountTerms terms_;
  telemetry::Metrics metrics_;
  telemetry::CompletedLap completed_lap_;  ///< newest lap; number 0: none yet
  bool has_new_lap_ = false;               ///< take_lap() has not returned completed_lap_ yet
  int laps_seen_ = 0;                      ///< judge's laps since restart() or resume()
  double nearest_ = std::numeric_limits<double>::infinity();  ///< least distance while far from the line [m]
  double lost_for_ = 0.0;                                     ///< time far and not coming nearer [s]
  double edge_distance_ = 0.0;                                ///< edge distance of our plant [m]
  double stood_for_ = 0.0;                                    ///< duration of the current standstill [s]
  bool is_endless_ = false;                                   ///< laps and time no longer end the run
  bool is_over_ = false;                                      ///< the run has ended
  bool has_finished_ = false;                                 ///< the car has reached the end of an open road
  const char* end_reason_ = "";  ///< reason of the end, unless all laps were driven
};

/// Times the laps of a car on an unknown road. The start line is the straight line across the car at its
/// first sighting, kReach to each side. A lap counts when the car crosses that line again in the same
/// direction, after at least kLeast and 90 % of the first lap's distance; crossings back and forth cancel
/// out. Place, edges and sectors stay unknown.
///
/// Speed is assumed constant between two sightings. Allocates nothing, cannot fail. One thread.
class LapLearner {
 public:
  static constexpr double kReach = 15.0;  ///< half length of the start line [m]; chosen: wider than a road
  static constexpr double kLeast = 50.0;  ///< least distance of a lap [m]; chosen

  /// Begins another run at the next sighting.
  void reset() noexcept { *this = {}; }
  /// Adds a sighting at `time` [s], which rises. A car that moved farther than its `speed` [m/s] explains was
  /// placed elsewhere: its lap, and the start line, begin there.
  void see(double time, const model::Pose& car, double speed) noexcept;

  /// Laps and their times; all other fields have their defaults.
  [[nodiscard]] const sim::WorldState& state() const noexcept { return state_; }

 private:
  /// Lays the start line across the car, and begins a lap there.
  void start(double time, const model::Pose& car) noexcept;
  /// Begins a lap at the time `crossing` [s], and counts the one before if it was long enough.
  void cross_line(double crossing) noexcept;
  /// Counts the lap that ended at the time `crossing` [s].
  void count_lap(double crossing) noexcept;

  sim::WorldState state_;
  bool has_line_ = false;     ///< the start line is laid
  Vec2 line_{0.0, 0.0};       ///< middle of the start line in W [m]
  Vec2 direction_{1.0, 0.0};  ///< direction in which the start line is crossed, unit vector
  Vec2 last_{0.0, 0.0};       ///< position of the last sighting in W [m]
  int backward_ = 0;          ///< crossings against the direction, not yet undone by forward ones
  double lap_start_ = 0.0;    ///< time at which the running lap began [s]
  double driven_ = 0.0;       ///< distance since the line was crossed [m]
  double lap_length_ = 0.0;   ///< length of the first lap [m]; 0: none yet
};

/// Account of a run whose car another program simulates, over all its connections. On a known road the car is
/// judged by its measured position and its assumed dimensions, as sim::World judges a simulated car. On an
/// unknown road laps are timed by LapLearner. Lap times are as accurate as the arrival times of telemetry:
/// some milliseconds on one machine. One thread.
class Roadside {
 public:
  /// `track` outlives this; null: the road is unknown. `remedy`: SituationTerms::remedy.
  Roadside(const road::Track* track, const scenario::Scenario& scenario,
           std::string_view remedy = telemetry::kSimulatorRemedy);

  /// Continues with another car, or the same car at another place. Counts stay; the running lap does not
  /// count.
  void resume() noexcept;
  /// Drops the track and all judgements by it: the car drives on another road than configured.
  void forget_track();
  /// Counts a cycle, and writes place, edges and laps of its measured car into `frame`. Allocates nothing.
  void judge(telemetry::Frame& frame) noexcept;
  /// Newest completed lap, returned once; none if it was returned before.
  [[nodiscard]] std::optional<telemetry::CompletedLap> take_lap() noexcept { return account_.take_lap(); }
  [[nodiscard]] telemetry::RunSummary summary() const { return account_.summary(); }

 private:
  /// Judges the measured car on the known road.
  void judge_on_road(telemetry::Frame& frame) noexcept;
  /// Times the laps of the measured car without a road.
  void time_without_road(telemetry::Frame& frame) noexcept;

  scenario::Scenario scenario_;
  std::string_view remedy_;          ///< SituationTerms::remedy
  std::optional<sim::Judge> judge_;  ///< judge on the known road; none: the road is unknown
  LapLearner learner_;               ///< laps on an unknown road
  Account account_;
  int events_before_ = 0;  ///< times that earlier cars of this run left the road
  bool has_seen_ = false;  ///< the judge has seen this car
};

}  // namespace chicane::run
