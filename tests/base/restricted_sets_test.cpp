// SPDX-License-Identifier: MIT
// A program that was built with AVX-512 alone, as `./run.sh` builds it on a processor that has it.

#include "chicane/base/instruction_set.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using enum InstructionSet;

TEST(RestrictedSets, AreNamed) {
  EXPECT_EQ(built_instruction_sets(), "avx512");
  EXPECT_EQ(instruction_sets_left_out(), "baseline, avx2");
}

TEST(RestrictedSets, OnlyWhatWasBuiltCanBeChosen) {
  EXPECT_TRUE(is_supported(kBaseline));
  EXPECT_FALSE(is_built(kBaseline));
  EXPECT_FALSE(is_available(kBaseline));
  EXPECT_EQ(detect_instruction_set(), kAvx512);
  EXPECT_EQ(with_instructions(kAvx512, [](auto arch) { return decltype(arch)::kWidth; }), 8U);
}

TEST(RestrictedSets, OneThatWasLeftOutIsRefusedWithTheWayToBuildIt) {
  const auto set = instruction_set_by_name("baseline");
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().message,
            "instruction set: got baseline, which was not built in; this program has avx512. In a clone "
            "`CHICANE_SIMD=baseline ./run.sh` adds it; for CMake it is -DCHICANE_SIMD=baseline");
}

TEST(RestrictedSets, TheEnvironmentIsRefusedWhereNothingFits) {
  ::setenv("CHICANE_SIMD", "baseline", 1);
  EXPECT_THAT(test::refusal_of(environment_instruction_set()),
              HasSubstr("CHICANE_SIMD: instruction set: got baseline, which was not"));
  ::unsetenv("CHICANE_SIMD");
  const auto best = environment_instruction_set();
  EXPECT_EQ(best.has_value(), is_supported(kAvx512));
  if (!best) {
    EXPECT_THAT(best.error().message, HasSubstr("built with avx512 alone, and this processor has baseline"));
  }
  EXPECT_EQ(chosen_instruction_set(), kAvx512) << "there is no other";
}

}  // namespace
}  // namespace chicane
