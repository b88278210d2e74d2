// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "chicane/road/track.hpp"
#include "chicane/run/account.hpp"
#include "chicane/run/lap_learner.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/world.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Keeps the account of a run whose car is simulated by another program, over all its connections: counts,
/// and where the road is known judges the car by the measured positions and by the car as it is
/// assumed, as sim::World does with a plant of ours. Where it is not, laps are learnt from where the
/// car has been (lap_learner.hpp). Lap times are as good as the clock that telemetry is received by: some
/// milliseconds on one machine. One thread.
class Roadside {
 public:
  /// `track` may be null: then laps are timed, and nothing is judged. It outlives this.
  Roadside(const road::Track* track, const scenario::Scenario& scenario);

  /// Another car, or the same one from another place: the running lap does not count, the rest stays.
  void resume() noexcept;
  /// The car drives on another road than configured: what was judged by it is forgotten.
  void forget_track();
  /// Writes place, edges and laps of what was measured into the frame, and counts it. Allocates nothing.
  void judge(telemetry::Frame& frame) noexcept;
  /// The lap that was just completed, once.
  [[nodiscard]] std::optional<telemetry::CompletedLap> take_lap() noexcept { return account_.take_lap(); }
  [[nodiscard]] telemetry::RunSummary summary() const;

 private:
  void look(telemetry::Frame& frame) noexcept;
  void learn(telemetry::Frame& frame) noexcept;

  scenario::Scenario scenario_;
  std::optional<sim::Judge> judge_;  ///< none where the road is not known
  LapLearner learner_;               ///< of laps, in its place
  Account account_;
  int events_before_ = 0;  ///< off the road, before this car
  bool has_seen_ = false;
};

}  // namespace chicane::run
