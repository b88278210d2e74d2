// SPDX-License-Identifier: MIT
#include "chicane/base/instruction_set.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

constexpr std::array kAll{InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512,
                          InstructionSet::kNeon};

TEST(InstructionSet, IsFoundByItsNameWhereTheProcessorHasIt) {
  for (const InstructionSet set : kAll) {
    const Result<InstructionSet> found = instruction_set_by_name(to_string(set));
    ASSERT_EQ(found.has_value(), is_available(set)) << to_string(set);
    if (found) {
      EXPECT_EQ(*found, set);
    }
  }
  EXPECT_FALSE(instruction_set_by_name(""));
  const Result<InstructionSet> unknown = instruction_set_by_name("avx3");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("got \"avx3\", expected one of "), std::string::npos);
#if defined(__x86_64__)
  const Result<InstructionSet> foreign = instruction_set_by_name("neon");
  ASSERT_FALSE(foreign);
  EXPECT_NE(foreign.error().message.find("got neon, this processor has baseline"), std::string::npos);
#endif
}

TEST(InstructionSet, BaselineIsEverywhereAndTheBestIsAvailable) {
  EXPECT_TRUE(is_supported(InstructionSet::kBaseline));
  EXPECT_TRUE(is_available(detect_instruction_set()));
}

TEST(InstructionSet, ArithmeticIsThatOfItsTag) {
  for (const InstructionSet set : kAll) {
    if (!is_available(set)) continue;
    const bool is_fused = with_instructions(set, [](auto arch) { return decltype(arch)::kFused; });
    EXPECT_EQ(arithmetic(set), is_fused ? "fused" : "plain") << to_string(set);
  }
}

TEST(InstructionSet, TheChosenOneIsTheLastChoice) {
  const InstructionSet before = chosen_instruction_set();
  for (const InstructionSet set : kAll) {
    if (!is_available(set)) continue;
    choose_instruction_set(set);
    EXPECT_EQ(chosen_instruction_set(), set);
  }
  choose_instruction_set(before);
  EXPECT_EQ(chosen_instruction_set(), before);
}

}  // namespace
}  // namespace chicane
