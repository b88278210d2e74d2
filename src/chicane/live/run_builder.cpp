// SPDX-License-Identifier: MIT
#include "chicane/live/run_builder.hpp"

#include <utility>

namespace chicane::live {

Result<std::unique_ptr<BuiltRun>> build_run(ChosenRun run, const Describe& describe) {
  Result<std::unique_ptr<run::ClosedLoop>> loop = run::ClosedLoop::create(run.scenario);
  if (!loop) return fail(loop.error());
  auto built = std::make_unique<BuiltRun>();
  built->description = describe(**loop);
  built->recorded = std::make_unique<const recording::RecordedRun>(
      recording::RecordedRun{.run = built->description, .scenario = std::move(run.scenario)});
  built->loop = std::move(*loop);
  built->choices = std::move(run.choices);
  return built;
}

}  // namespace chicane::live
