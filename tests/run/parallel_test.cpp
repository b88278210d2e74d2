// SPDX-License-Identifier: MIT
#include "chicane/run/parallel.hpp"
#include "chicane/run/worker.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "support/chicane_test.hpp"

#include <atomic>
#include <future>
#include <thread>

namespace chicane::run {
namespace {

TEST(Parallel, DoesEachOnceOnAnyNumberOfThreads) {
  for (const int jobs : {1, 2, 7}) {
    std::vector<std::atomic<int>> done(100);
    for_each_run(done.size(), jobs, [&](std::uint64_t i, Roads&) {
      ++done[i];
      return true;
    });
    for (const auto& each : done) EXPECT_EQ(each, 1);
  }
}

TEST(Parallel, EndsWhenAWorkSaysSo) {
  int done = 0;
  for_each_run(100, 1, [&](std::uint64_t, Roads&) { return ++done < 5; });
  EXPECT_EQ(done, 5);
  EXPECT_GE(threads_for(0), 1);
  EXPECT_EQ(threads_for(3), 3);
}

using Environment = std::map<std::string, std::string>;

Result<Shard> shard_in(const Environment& environment) {
  return environment_shard([&](const char* name) -> const char* {
    const auto found = environment.find(name);
    return found == environment.end() ? nullptr : found->second.c_str();
  });
}

Environment array(const char* id, const char* count, const char* first, const char* last, const char* step) {
  return {{"SLURM_ARRAY_TASK_ID", id},
          {"SLURM_ARRAY_TASK_COUNT", count},
          {"SLURM_ARRAY_TASK_MIN", first},
          {"SLURM_ARRAY_TASK_MAX", last},
          {"SLURM_ARRAY_TASK_STEP", step}};
}

TEST(Shard, IsReadCoversAllRunsOnceAndNamesItsFile) {
  for (const std::uint64_t runs : {0U, 1U, 6U, 7U, 100U}) {
    std::uint64_t sum = 0;
    for (std::uint64_t i = 0; i < 7; ++i) sum += Shard{i, 7}.size(runs);
    EXPECT_EQ(sum, runs);
  }
  const auto shard = test::good(parse_shard("3/7"));
  EXPECT_TRUE(shard->has(9));
  EXPECT_FALSE(shard->has(8));
  EXPECT_EQ(shard->index, 2U);
  EXPECT_EQ(shard->count, 7U);
  EXPECT_EQ(shard->file_of("out/results.jsonl"), "out/results.3-of-7.jsonl");
  EXPECT_EQ(Shard{}.file_of("out/results.jsonl"), "out/results.jsonl");
  for (const char* text : {"", "3", "0/7", "8/7", "3/7/1", "-1/7", "a/b", "1/99999999999999999999"})
    EXPECT_FALSE(parse_shard(text)) << text;
}

TEST(Shard, IsReadFromSlurmArraysAndMpiRanks) {
  EXPECT_TRUE(shard_in({})->from.empty());
  EXPECT_EQ(shard_in(array("5", "10", "1", "10", "1"))->index, 4U);
  EXPECT_EQ(shard_in(array("5", "10", "1", "10", "1"))->count, 10U);
  EXPECT_EQ(shard_in(array("8", "3", "4", "12", "4"))->index, 1U);
  EXPECT_EQ(shard_in({{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "4"}})->index, 2U);
  EXPECT_EQ(shard_in({{"PMI_RANK", "3"}, {"PMI_SIZE", "4"}})->index, 3U);
  EXPECT_EQ(shard_in({{"SLURM_PROCID", "1"}, {"SLURM_STEP_NUM_TASKS", "2"}})->index, 1U);
  EXPECT_TRUE(shard_in({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}})->from.empty())
      << "a batch script's own";
  Environment both = array("2", "3", "1", "3", "1");
  both["OMPI_COMM_WORLD_RANK"] = "1";
  both["OMPI_COMM_WORLD_SIZE"] = "4";
  EXPECT_EQ(shard_in(both)->index, 5U);
  EXPECT_EQ(shard_in(both)->count, 12U);
}

TEST(Shard, RefusesArraysWithHolesAndNumbersThatMakeNoSense) {
  EXPECT_THAT(shard_in(array("7", "3", "1", "7", "1")).error().message, HasSubstr("without holes"));
  EXPECT_FALSE(shard_in(array("7", "", "1", "7", "1")));
  EXPECT_FALSE(shard_in({{"OMPI_COMM_WORLD_RANK", "4"}, {"OMPI_COMM_WORLD_SIZE", "4"}}));
  EXPECT_FALSE(shard_in({{"PMI_RANK", "x"}, {"PMI_SIZE", "4"}}));
}

using ChangeQueue = ThreadQueue<telemetry::Change>;

telemetry::Change change(std::uint64_t number) {
  return {.cycle = number, .name = "run.pace", .value = std::to_string(number)};
}

TEST(ThreadQueue, RefusesWhatDoesNotFitAndKeepsTheRest) {
  const auto queue = std::make_unique<ChangeQueue>();
  EXPECT_EQ(queue->front(), nullptr);
  for (std::uint64_t i = 0; i < ChangeQueue::kCapacity; ++i) {
    EXPECT_EQ(queue->room(), ChangeQueue::kCapacity - i);
    EXPECT_TRUE(queue->push(change(i)));
  }
  EXPECT_FALSE(queue->push(change(999)));
  EXPECT_EQ(queue->front()->cycle, 0u);
  queue->pop();
  EXPECT_EQ(queue->room(), 1u);
  EXPECT_TRUE(queue->push(change(1000)));
}

TEST(ThreadQueue, LosesNothingBetweenTwoThreads) {
  constexpr std::uint64_t kCount = 5000;
  const auto queue = std::make_unique<ChangeQueue>();
  std::thread sender{[&] {
    for (std::uint64_t i = 0; i < kCount;) i += queue->push(change(i)) ? 1 : 0;
  }};
  for (std::uint64_t i = 0; i < kCount;) {
    const telemetry::Change* next = queue->front();
    if (next == nullptr) continue;
    EXPECT_EQ(next->cycle, i);
    EXPECT_EQ(next->value.view(), std::to_string(i));
    queue->pop();
    ++i;
  }
  sender.join();
}

using namespace std::chrono_literals;

TEST(Worker, WorksOnceForEachWakeAndNotBefore) {
  std::atomic<int> works{0};
  std::promise<void> began, may_end;
  const std::shared_future<void> end = may_end.get_future().share();
  {
    Worker worker([&] {
      if (++works == 1) began.set_value();
      end.wait();
    });
    EXPECT_EQ(works, 0);
    worker.wake();
    began.get_future().wait();
    worker.wake();  // two during a work lead to one more
    worker.wake();
    may_end.set_value();
    while (works < 2) std::this_thread::yield();
  }
  EXPECT_EQ(works, 2);
}

TEST(Worker, WorksEachPeriodUntilItIsDestroyed) {
  std::atomic<int> works{0};
  {
    const Worker worker([&] { ++works; }, 1ms);
    while (works < 3) std::this_thread::yield();
  }
  const int at_end = works;
  std::this_thread::sleep_for(5ms);
  EXPECT_EQ(works, at_end);
}

}  // namespace
}  // namespace chicane::run
