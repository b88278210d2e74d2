// SPDX-License-Identifier: MIT
#pragma once

namespace chicane::lap_time {

/// How far a search for a lap has come. Work is counted, not measured: the same search takes the same work on
/// every machine, so that a budget ends it at the same place.
struct PlanProgress {
  double work = 0.0;      ///< done, in seconds of a core that iterates over kNodesPerSecond nodes a second
  double expected = 0.0;  ///< of a search that goes well [s]; it may take more, up to its budget
  double lap_time = 0.0;  ///< of the iterate [s]

  static constexpr double kNodesPerSecond = 12000.0;
};

}  // namespace chicane::lap_time
