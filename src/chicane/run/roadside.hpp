// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "chicane/path/track.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/judge.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::run {

/// Stands beside the road while another program simulates the car: counts, and where the road is known
/// judges the car by the positions that were measured and the car as it is believed to be, as sim::World does
/// with a plant of ours. Lap times are as good as the clock that telemetry is received by: some milliseconds
/// on one machine. One thread.
class Roadside {
 public:
  /// `track` may be null: then nothing is judged. It outlives this.
  Roadside(const path::Track* track, const scenario::Scenario& scenario);

  /// Another car, or the same one again: the next frame is the first. Allocates.
  void restart();
  /// Writes place, edges and laps of what was measured into the frame, and counts it. Allocates nothing.
  void judge(telemetry::Frame& frame) noexcept;
  /// Since restart().
  [[nodiscard]] telemetry::RunSummary summary() const;

 private:
  void look(telemetry::Frame& frame) noexcept;

  const path::Track* track_;
  scenario::Scenario scenario_;
  std::optional<sim::Judge> judge_;
  telemetry::Metrics metrics_;
  telemetry::CompletedLap completed_lap_;
  bool has_seen_ = false;
};

}  // namespace chicane::run
