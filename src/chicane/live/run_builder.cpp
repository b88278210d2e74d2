// SPDX-License-Identifier: MIT
#include "chicane/live/run_builder.hpp"

#include <utility>

namespace chicane::live {

RunBuilder::RunBuilder(Describe describe, Create create)
    : describe_{std::move(describe)}, create_{std::move(create)}, worker_{[this] { work(); }} {}

void RunBuilder::begin(ChosenRun run) {
  {
    const std::lock_guard lock(mutex_);
    wish_ = std::move(run);
    ++newest_;
    result_.reset();
  }
  worker_.wake();
}

std::optional<Result<std::unique_ptr<BuiltRun>>> RunBuilder::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(result_, std::nullopt);
}

void RunBuilder::work() {
  std::unique_lock lock(mutex_);
  if (!wish_) return;
  ChosenRun run = *std::exchange(wish_, std::nullopt);
  const std::uint64_t number = newest_;
  lock.unlock();
  auto built = build(std::move(run), describe_, create_);
  lock.lock();
  if (number == newest_) result_ = std::move(built);
}

Result<std::unique_ptr<BuiltRun>> RunBuilder::build(ChosenRun run, const Describe& describe,
                                                    const Create& create) {
  Result<std::unique_ptr<run::ClosedLoop>> loop = create(run.scenario);
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
