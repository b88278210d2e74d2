// SPDX-License-Identifier: MIT
// Choice of the instruction set: what the processor supports, what was built, and what the user asks for.
#include "chicane/base/instruction_set.hpp"

#include <array>
#include <atomic>
#include <cstdlib>
#include <utility>

namespace chicane {
namespace {

using enum InstructionSet;
constexpr std::array kNames{
    std::pair{kBaseline, std::string_view{"baseline"}}, std::pair{kAvx2, std::string_view{"avx2"}},
    std::pair{kAvx512, std::string_view{"avx512"}}, std::pair{kNeon, std::string_view{"neon"}}};
constexpr int kNotChosen = -1;

/// Number of the InstructionSet chosen for the process, or kNotChosen.
std::atomic<int>& choice() noexcept {
  static std::atomic<int> chosen{kNotChosen};
  return chosen;
}

/// Names of the instruction sets that meet a condition: "baseline, avx2".
template <class Condition>
std::string names_of(const Condition& meets) {
  std::string names;
  for (const auto& [set, name] : kNames) {
    if (meets(set)) names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

tl::unexpected<Error> refuse(const std::string& words) {
  return fail(ErrorCode::kInvalidArgument, "instruction set: " + words);
}

/// Whether some processor of this family (x86-64, aarch64, others) has the instruction set.
bool is_of_family(InstructionSet set) noexcept {
#if defined(__x86_64__)
  return set != kNeon;
#elif defined(__aarch64__)
  return set == kBaseline || set == kNeon;
#else
  return set == kBaseline;
#endif
}

}  // namespace

std::string_view to_string(InstructionSet set) noexcept {
  for (const auto& [known, name] : kNames) {
    if (known == set) return name;
  }
  return "unknown";
}

std::string_view arithmetic(InstructionSet set) noexcept { return set == kBaseline ? "plain" : "fused"; }

bool is_supported(InstructionSet set) noexcept {
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

bool is_built(InstructionSet set) noexcept {
#if defined(CHICANE_WITHOUT_BASELINE)
  if (set == kBaseline) return false;
#endif
#if defined(CHICANE_WITHOUT_AVX2)
  if (set == kAvx2) return false;
#endif
#if defined(CHICANE_WITHOUT_AVX512)
  if (set == kAvx512) return false;
#endif
#if defined(CHICANE_WITHOUT_NEON)
  if (set == kNeon) return false;
#endif
  return is_of_family(set);
}

bool is_available(InstructionSet set) noexcept { return is_built(set) && is_supported(set); }

std::string built_instruction_sets() { return names_of(is_built); }

std::string instruction_sets_left_out() {
  return names_of([](InstructionSet set) { return is_of_family(set) && !is_built(set); });
}

InstructionSet detect_instruction_set() noexcept {
  for (const InstructionSet set : {kAvx512, kAvx2, kNeon}) {
    if (is_available(set)) return set;
  }
  for (const InstructionSet set : {kBaseline, kAvx2, kAvx512, kNeon}) {
    if (is_built(set)) return set;
  }
  return kBaseline;
}

Result<InstructionSet> instruction_set_by_name(std::string_view name) {
  for (const auto& [set, known] : kNames) {
    if (known != name) continue;
    if (is_available(set)) return set;
    const std::string got = "got " + std::string(name);
    if (!is_supported(set)) return refuse(got + ", this processor has " + names_of(is_supported));
    return refuse(got + ", which was not built in; this program has " + built_instruction_sets() + ". " +
                  how_to_build(name));
  }
  return refuse("got \"" + std::string(name) + "\", expected one of " + names_of(is_available));
}

std::string how_to_build(std::string_view name) {
  const std::string word(name);
  return "In a clone `CHICANE_SIMD=" + word + " ./run.sh` adds it; for CMake it is -DCHICANE_SIMD=" + word;
}

Result<InstructionSet> environment_instruction_set() {
  const char* asked = std::getenv("CHICANE_SIMD");
  if (asked == nullptr || *asked == '\0') {
    const InstructionSet best = detect_instruction_set();
    if (is_available(best)) return best;
    return refuse("this program was built with " + built_instruction_sets() +
                  " alone, and this processor has " + names_of(is_supported) + ": build it on this machine");
  }
  auto set = instruction_set_by_name(asked);
  if (!set) return fail(set.error().code, "CHICANE_SIMD: " + set.error().message);
  return set;
}

InstructionSet chosen_instruction_set() noexcept {
  int chosen = choice().load(std::memory_order_relaxed);
  if (chosen == kNotChosen) {
    const auto asked = environment_instruction_set();
    chosen = static_cast<int>(asked                     ? *asked
                              : is_available(kBaseline) ? kBaseline
                                                        : detect_instruction_set());
    choice().store(chosen, std::memory_order_relaxed);
  }
  return static_cast<InstructionSet>(chosen);
}

void choose_instruction_set(InstructionSet set) noexcept {
  choice().store(static_cast<int>(set), std::memory_order_relaxed);
}

}  // namespace chicane
