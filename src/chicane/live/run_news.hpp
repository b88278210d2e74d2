// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "chicane/protocol/schema_json.hpp"
#include "chicane/run/realtime_loop.hpp"
#include "chicane/telemetry/change.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {

/// Pause, step and reset of a run, which `controls` asks for.
[[nodiscard]] wire::ViewerServices run_services(run::RunControls& controls);

/// What happens in a run beside what was asked for: that faults began or ended by themselves, and, once for
/// each run, that it is over. The thread that drives.
class RunNews {
 public:
  /// `note` is told of each fault that began or ended by itself, as of a change. All outlive this.
  RunNews(wire::ViewerEndpoint& viewer, std::function<void(const telemetry::Change&)> note);

  /// After each control cycle.
  void frame(const telemetry::Frame& frame);
  /// A change was applied.
  void change(const telemetry::Change& change);
  /// The run is over: tells viewers why, and gives true, the first time. A run that is driven on stays over.
  bool end(const telemetry::RunSummary& summary);
  [[nodiscard]] bool has_told_end() const { return has_told_end_; }

 private:
  wire::ViewerEndpoint& viewer_;
  std::function<void(const telemetry::Change&)> note_;
  const std::vector<protocol::Control> faults_;
  std::uint32_t told_faults_ = 0;  ///< bits, as viewers know them
  bool has_told_end_ = false;
};

}  // namespace chicane::live
