// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/change.hpp"

namespace chicane::live {

/// A run that was chosen while another one goes on.
struct ChosenRun {
  scenario::Scenario scenario;
  std::vector<telemetry::Change> choices{};  ///< what was chosen, each key once, in order
};

/// A run that may begin, with all that takes time to make.
struct BuiltRun {
  std::unique_ptr<run::ClosedLoop> loop;
  protocol::Run description;                               ///< for viewers
  std::unique_ptr<const recording::RecordedRun> recorded;  ///< for the recording
  std::vector<telemetry::Change> choices{};
};

/// Describes a run for its viewers.
using Describe = std::function<protocol::Run(const run::ClosedLoop&)>;
/// Makes the run that was chosen: track, car and controller are read and planned. Fails as
/// ClosedLoop::create() does.
[[nodiscard]] Result<std::unique_ptr<BuiltRun>> build_run(ChosenRun run, const Describe& describe);

}  // namespace chicane::live
