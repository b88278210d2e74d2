// SPDX-License-Identifier: MIT
// The same scenario and seed give the same bits in every build and for every instruction set of the same
// arithmetic (base/instruction_set.hpp): Debug, Release, with sanitizers, from gcc and
// clang, on every machine. A hash that changes says that the driving changed: look at the laps
// (tools/check_figures --page docs/measured/numbers.md) before renewing it with what this test prints.
#include <fmt/format.h>

#include "chicane/base/instruction_set.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

struct Golden {
  const char* name;
  const char* settings;  ///< "track=oval fault=gps_noise@3": settings, and faults as --fault takes them
  std::uint64_t plain;
  std::uint64_t fused;  ///< with the fused multiply-add of AVX2, AVX-512, and aarch64
};

void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.name; }

class GoldenRun : public ::testing::TestWithParam<Golden> {};

std::uint64_t hash_of(const Golden& golden, InstructionSet set) {
  choose_instruction_set(set);
  protocol::Request request{.scenario_file = {}, .settings = {{"time_limit_s", "20"}}};
  std::istringstream words(golden.settings);
  for (std::string key, value; std::getline(words, key, '=') && std::getline(words, value, ' ');) {
    if (key == "fault") {
      request.faults.push_back(value);
    } else {
      request.settings.emplace_back(key, value);
    }
  }
  const auto loop = test::good(run::ClosedLoop::create(*test::good(protocol::compose(request))));
  choose_instruction_set(detect_instruction_set());
  return run::run_closed_loop(**loop).state_hash;
}
TEST_P(GoldenRun, HasTheBitsItHad) {
  for (const InstructionSet set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512, InstructionSet::kNeon}) {
    if (!is_available(set)) continue;
    const std::uint64_t now = hash_of(GetParam(), set);
    EXPECT_EQ(now, arithmetic(set) == "plain" ? GetParam().plain : GetParam().fused)
        << to_string(set) << fmt::format(" now 0x{:016x}", now);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Runs, GoldenRun,
    ::testing::Values(
        Golden{"default_udacity", "track=lakeside", 0xbf2aaf77e1ff2af2, 0x950a47c60c727ebf},
        Golden{"default_road_car", "track=hairpins car=road-car", 0x36e09f0cef85d10a, 0x57d747ec641edf97},
        Golden{"with_noise", "track=oval sensor.position_noise_m=0.05 seed=7", 0x71235dbfeb458780,
               0xf9e9078b0ac199ac},
        Golden{"weighted", "preset=weighted guard.mode=off", 0x2289abd6e0b12064, 0xb8e2970005c7aff6},
        Golden{"delay_in_model", "preset=delay-in-model guard.mode=off", 0xd30ef6e02d73d5c9,
               0xa462655e2609913f},
        Golden{"race", "preset=race time_limit_s=6", 0x5102643fdbd123a0, 0xf71758ca4d4b4307},
        Golden{"faults", "time_limit_s=10 fault=gps_noise@3 fault=frozen_sensor@6", 0x415042abc01d4352,
               0x7eeea3b0da449642},
        Golden{"model_car", "car=f1tenth time_limit_s=6", 0x0cedc07a9e2fa214, 0x2dfcaddfe1711c09},
        Golden{"pid", "preset=pid latency_ms=37", 0xdab4f526bb2d5617, 0xdab4f526bb2d5617}),
    [](const auto& run) { return std::string(run.param.name); });

}  // namespace
}  // namespace chicane
