// SPDX-License-Identifier: MIT
#include "chicane/live/run_builder.hpp"

#include <sys/resource.h>

#include <utility>

namespace chicane::live {

RunBuilder::RunBuilder(Describe describe, Create create)
    : describe_{std::move(describe)}, create_{std::move(create)}, thread_{[this] { work(); }} {}

RunBuilder::~RunBuilder() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void RunBuilder::begin(ChosenRun run) {
  {
    const std::lock_guard lock(mutex_);
    wish_ = std::move(run);
    ++newest_;
    result_.reset();
  }
  changed_.notify_one();
}

std::optional<Result<std::unique_ptr<BuiltRun>>> RunBuilder::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(result_, std::nullopt);
}

void RunBuilder::work() {
  constexpr int kLowPriority = 10;
  static_cast<void>(setpriority(PRIO_PROCESS, 0, kLowPriority));  // of this thread, on Linux
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_ending_ || wish_.has_value(); });
    if (is_ending_) return;
    ChosenRun run = std::move(*wish_);
    wish_.reset();
    const std::uint64_t number = newest_;
    lock.unlock();
    auto built = build(std::move(run), describe_, create_);
    lock.lock();
    if (number == newest_) result_ = std::move(built);
  }
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
