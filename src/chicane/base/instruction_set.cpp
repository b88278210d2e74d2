// SPDX-License-Identifier: MIT
#include "chicane/base/instruction_set.hpp"

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>
#include <utility>

namespace chicane {
namespace {

using enum InstructionSet;
constexpr std::array kNames{
    std::pair{kBaseline, std::string_view{"baseline"}}, std::pair{kAvx2, std::string_view{"avx2"}},
    std::pair{kAvx512, std::string_view{"avx512"}}, std::pair{kNeon, std::string_view{"neon"}}};
constexpr int kNotChosen = -1;

std::atomic<int>& choice() noexcept {
  static std::atomic<int> chosen{kNotChosen};
  return chosen;
}

std::string available_names() {
  std::string names;
  for (const auto& [set, name] : kNames) {
    if (is_available(set)) names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

}  // namespace

std::string_view to_string(InstructionSet set) noexcept {
  for (const auto& [known, name] : kNames) {
    if (known == set) return name;
  }
  return "unknown";
}

std::string_view arithmetic(InstructionSet set) noexcept { return set == kBaseline ? "plain" : "fused"; }

bool is_available(InstructionSet set) noexcept {
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  if (set == kAvx2) return avx2;
  if (set == kAvx512)
    return avx2 && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
           __builtin_cpu_supports("avx512vl") != 0;
#elif defined(__aarch64__)
  if (set == kNeon) return true;
#endif
  return set == kBaseline;
}

InstructionSet detect_instruction_set() noexcept {
  for (const InstructionSet set : {kAvx512, kAvx2, kNeon}) {
    if (is_available(set)) return set;
  }
  return kBaseline;
}

Result<InstructionSet> instruction_set_by_name(std::string_view name) {
  for (const auto& [set, known] : kNames) {
    if (known != name) continue;
    if (is_available(set)) return set;
    return fail(ErrorCode::kInvalidArgument,
                "instruction set: got " + std::string(name) + ", this processor has " + available_names());
  }
  return fail(ErrorCode::kInvalidArgument,
              "instruction set: got \"" + std::string(name) + "\", expected one of " + available_names());
}

Result<InstructionSet> environment_instruction_set() {
  const char* asked = std::getenv("CHICANE_SIMD");
  if (asked == nullptr || *asked == '\0') return detect_instruction_set();
  auto set = instruction_set_by_name(asked);
  if (!set) return fail(set.error().code, "CHICANE_SIMD: " + set.error().message);
  return set;
}

InstructionSet chosen_instruction_set() noexcept {
  int chosen = choice().load(std::memory_order_relaxed);
  if (chosen == kNotChosen) {
    const auto asked = environment_instruction_set();
    chosen = static_cast<int>(asked ? *asked : kBaseline);
    choice().store(chosen, std::memory_order_relaxed);
  }
  return static_cast<InstructionSet>(chosen);
}

void choose_instruction_set(InstructionSet set) noexcept {
  choice().store(static_cast<int>(set), std::memory_order_relaxed);
}

}  // namespace chicane
