// SPDX-License-Identifier: MIT
#include "chicane/wire/run_memory.hpp"
#include "support/chicane_test.hpp"

namespace chicane::wire {
namespace {

std::vector<double> frame_times(const RunMemory& memory) {
  std::vector<double> times;
  std::uint64_t before = memory.end();
  EXPECT_EQ(memory.frame_before(0), nullptr);
  while (const KeptMessage* message = memory.frame_before(before)) {
    before = message->number;
    EXPECT_EQ(memory.frames_before(memory.end()) - memory.frames_before(before), times.size() + 1);
    times.push_back(message->time);
  }
  std::reverse(times.begin(), times.end());
  return times;
}

TEST(RunMemory, KeepsAllFramesOfTheLastMinuteAndOlderOnesAtADistance) {
  RunMemory memory;
  constexpr double kPeriod = 0.04;
  for (int i = 0; i < 5000; ++i) memory.add_frame(kPeriod * i, std::to_string(i));
  const std::vector<double> times = frame_times(memory);
  const double newest = kPeriod * 4999;
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), newest);
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double gap = times[i] - times[i - 1];
    if (times[i - 1] >= newest - RunMemory::kDense)
      EXPECT_NEAR(gap, kPeriod, 1e-9) << times[i];
    else
      EXPECT_LE(gap, RunMemory::kSpacing + 1e-9) << times[i];  // rounding of products
  }
  EXPECT_LT(times.size(), 1501U + 701U);  // 60 s of 25 a second, 140 s of 5 a second
}

TEST(RunMemory, StopsGrowing) {
  RunMemory memory;
  for (int i = 0; i < 30'000; ++i) {
    memory.add_frame(0.1 * i, {});
    memory.add_change(0.1 * i, {});
  }
  EXPECT_LE(frame_times(memory).size(), RunMemory::kMostSparse + RunMemory::kMostDense);
  EXPECT_EQ(memory.change_from(0)->time, 0.1 * (30'000 - static_cast<int>(RunMemory::kMostChanges)));
}

TEST(RunMemory, NeverForgetsTheBestLap) {
  RunMemory memory;
  const auto add = [&](int lap, double time, bool is_clean) {
    memory.add_lap({.lap = lap, .lap_time = time, .is_clean = is_clean}, lap, std::to_string(lap));
  };
  add(1, 30.0, true);
  add(2, 20.0, false);  // fast, but off the road
  for (int lap = 3; lap < 1500; ++lap) add(lap, 40.0, true);
  EXPECT_EQ(memory.lap_from(0)->payload, "1");
  EXPECT_EQ(memory.lap_from(memory.lap_from(0)->number + 1)->payload, "501");
}

TEST(RunMemory, GoesOnCountingWhenTheRunBeginsAnew) {
  RunMemory memory;
  memory.add_lap({.lap = 1}, 1.0, "old");
  const std::uint64_t seen = memory.lap_from(0)->number;
  memory.forget();
  EXPECT_EQ(memory.lap_from(0), nullptr);
  EXPECT_EQ(memory.frame_before(memory.end()), nullptr);
  memory.add_lap({.lap = 1}, 0.5, "new");
  ASSERT_NE(memory.lap_from(seen + 1), nullptr);
  EXPECT_EQ(memory.lap_from(seen + 1)->payload, "new");
}

}  // namespace
}  // namespace chicane::wire
