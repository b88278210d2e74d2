// SPDX-License-Identifier: MIT
// Two laps, not one step: the second closes the map, smooths the line round the whole track and plans anew.

#include "closed_loop/drive.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::run {
namespace {

TEST(WholeLoop, AllocatesNothingInTwoLapsOfTheDefaultController) {
  for (const std::string car : {"udacity", "road-car"}) {
    const auto loop = test::loop_of(test::scenario_of(
        {{"car", car}, {"track", "lakeside"}, {"laps", "2"}, {"sensor.position_noise_m", "0.02"}}));
    int cycles = 0;
    const test::AllocationGuard guard;
    while (!loop->is_over()) cycles += loop->advance() ? 1 : 0;
    EXPECT_EQ(guard.count(), 0) << car << ", " << cycles << " control steps";
    EXPECT_GT(cycles, 1000) << car;
    EXPECT_EQ(loop->summary().laps_completed, 2) << car;
  }
}

}  // namespace
}  // namespace chicane::run
