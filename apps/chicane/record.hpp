// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/runtime/closed_loop.hpp"
#include "chicane/runtime/recorder.hpp"
#include "options.hpp"

namespace chicane::apps {

inline constexpr double kRoadSpacing = 2.0;  ///< [m] between the drawn points of the road

/// What viewers and logs are told of a run with our simulator.
[[nodiscard]] protocol::Run description(const runtime::ClosedLoop& loop);

/// --record: null when nobody asked for it. `step_budget` [s]: deadline of a control step in real time; 0
/// with
/// --fast, where the run waits for the disk.
[[nodiscard]] Result<std::unique_ptr<runtime::Recorder>> start_recorder(const Options& options,
                                                                        protocol::Run run,
                                                                        const scenario::Scenario& scenario,
                                                                        double step_budget);
/// Closes the recording and says on stderr what is in it. Nothing happens for null.
[[nodiscard]] Result<void> finish_recorder(const Options& options, runtime::Recorder* recorder);

}  // namespace chicane::apps
