// SPDX-License-Identifier: MIT
// The same scenario and seed give the same bits in every build: Debug, Release, with sanitizers, from gcc and
// clang, on every machine. A hash that changes says that the driving changed: look at the laps
// (tools/measure.py) before renewing it with what this test prints.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "chicane/protocol/library.hpp"
#include "chicane/runtime/closed_loop.hpp"

namespace chicane {
namespace {

struct Golden {
  const char* name;
  std::vector<std::pair<std::string, std::string>> settings;
  std::uint64_t hash;
};

void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.name; }

class GoldenRun : public ::testing::TestWithParam<Golden> {};

TEST_P(GoldenRun, HasTheBitsItHad) {
  auto settings = GetParam().settings;
  settings.emplace_back("time_limit_s", "20");
  const auto scenario = protocol::compose({.scenario_file = {}, .settings = settings});
  ASSERT_TRUE(scenario) << scenario.error().message;
  const auto loop = runtime::ClosedLoop::create(*scenario);
  ASSERT_TRUE(loop) << loop.error().message;
  const std::uint64_t hash = runtime::run_closed_loop(**loop).state_hash;
  EXPECT_EQ(hash, GetParam().hash) << fmt::format("now 0x{:016x}", hash);
}

INSTANTIATE_TEST_SUITE_P(
    Runs, GoldenRun,
    ::testing::Values(
        Golden{"default_udacity", {{"track", "lakeside"}}, 0x28089d288be32acb},
        Golden{"default_road_car", {{"track", "hairpins"}, {"car", "road-car"}}, 0xbfbd8619d2a61151},
        Golden{"with_noise",
               {{"track", "oval"}, {"sensor.position_noise_m", "0.05"}, {"seed", "7"}},
               0xce7a52d35dfd5766},
        Golden{"weighted", {{"preset", "weighted"}}, 0x2dbdf2fd492fe1cf},
        Golden{"delay_in_model", {{"preset", "delay-in-model"}}, 0x29ffd23f7171698a},
        Golden{"pid", {{"preset", "pid"}, {"latency_ms", "37"}}, 0xdab4f526bb2d5617}),
    [](const auto& run) { return std::string(run.param.name); });

}  // namespace
}  // namespace chicane
