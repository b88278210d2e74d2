// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/base/result.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/scenario/scenario.hpp"
#include "options.hpp"

namespace chicane::apps {

/// The experiment that the command line describes: files, settings, and the speed for whichever controller
/// drives.
[[nodiscard]] protocol::Request request_of(const Options& options);
[[nodiscard]] Result<scenario::Scenario> experiment(const Options& options);

/// The run of an experiment, ready to start, or why it cannot be driven: `drive` starts it, `check` only
/// asks. `hooks`: while its lap is planned.
[[nodiscard]] Result<std::unique_ptr<run::ClosedLoop>> prepared(const protocol::Request& request);
[[nodiscard]] Result<std::unique_ptr<run::ClosedLoop>> prepared(const scenario::Scenario& scenario,
                                                                const run::PlanHooks& hooks);

}  // namespace chicane::apps
