// SPDX-License-Identifier: MIT
// Choice of the processor's instruction set at run time. One program has code for several of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

// A source file that is to be compiled for each of them takes these steps:
//   1. Write the work as templates over an instruction set, `template <class Arch> class FastSolver : public
//      Solver` with Pack<Arch, 8> inside, behind a small abstract interface `Solver`.
//   2. In fast_solver.hpp: `template <class Arch> std::unique_ptr<Solver> make_fast_solver();`
//   3. In fast_solver.cpp, compiled once for each instruction set: its definition and
//      `template std::unique_ptr<Solver> make_fast_solver<arch::Native>();`
//   4. In CMakeLists.txt, after chicane_module(): `chicane_simd_sources(my_module fast_solver.cpp)`; the file
//      is in no other list of sources. A test then proves that each object defines tagged symbols only: every
//      function template, class and lambda in it must have Arch among its arguments or be inlined.
//   5. Where a Solver is made: `with_instructions(chosen_instruction_set(), [](auto arch) {
//      return make_fast_solver<decltype(arch)>(); })`.

namespace chicane {

/// Tags of the instruction sets. Code that is compiled for one of them has its tag as a template argument, so
/// that the linker keeps the versions apart. kWidth: doubles in a register. kFused: a · b + c rounds once.
namespace arch {
struct Baseline {  ///< features of every processor of the family; SSE2 on x86-64
  static constexpr std::size_t kWidth = 2;
  static constexpr bool kFused = false;
};
struct Avx2 {  ///< AVX2 and FMA
  static constexpr std::size_t kWidth = 4;
  static constexpr bool kFused = true;
};
struct Avx512 {  ///< AVX-512 F, DQ, VL
  static constexpr std::size_t kWidth = 8;
  static constexpr bool kFused = true;
};
struct Neon {  ///< aarch64 with fused arithmetic
  static constexpr std::size_t kWidth = 2;
  static constexpr bool kFused = true;
};
#if defined(CHICANE_ARCH)
using Native = CHICANE_ARCH;  ///< instruction set of this translation unit (cmake/InstructionSets.cmake)
#else
using Native = Baseline;
#endif

/// Most widely supported instruction set in the program (cmake/BuiltInstructionSets.cmake).
#if !defined(CHICANE_WITHOUT_BASELINE)
using Simplest = Baseline;
#elif defined(__aarch64__)
using Simplest = Neon;
#elif !defined(CHICANE_WITHOUT_AVX2)
using Simplest = Avx2;
#else
using Simplest = Avx512;
#endif
}  // namespace arch

/// Instruction sets a program can run on.
enum class InstructionSet : std::uint8_t { kBaseline, kAvx2, kAvx512, kNeon };

[[nodiscard]] std::string_view to_string(InstructionSet set) noexcept;

/// Rounding of a · b + c: "fused" if it rounds once, "plain" if twice. Instruction sets with the same word
/// compute the same bits. A recording names its word, and replays bit for bit on any machine with that word.
[[nodiscard]] std::string_view arithmetic(InstructionSet set) noexcept;

/// Whether this processor has the instruction set.
[[nodiscard]] bool is_supported(InstructionSet set) noexcept;
/// Whether the program has code for the instruction set. CMake builds all sets of the processor family, or
/// the ones that its option CHICANE_SIMD names.
[[nodiscard]] bool is_built(InstructionSet set) noexcept;
/// Whether the instruction set can be chosen: is_supported() and is_built().
[[nodiscard]] bool is_available(InstructionSet set) noexcept;
/// Names of the instruction sets with code in the program: "baseline, avx2, avx512".
[[nodiscard]] std::string built_instruction_sets();
/// Names of the processor family's instruction sets without code in the program; may be empty.
[[nodiscard]] std::string instruction_sets_left_out();

/// Best available instruction set. If none is available, one that is built, whose code must not be run.
[[nodiscard]] InstructionSet detect_instruction_set() noexcept;

/// The instruction set "baseline", "avx2", "avx512" or "neon". Fails for other names, and for one that this
/// processor does not have or that was not built.
[[nodiscard]] Result<InstructionSet> instruction_set_by_name(std::string_view name);

/// Advice for users of a set that was left out: "In a clone `CHICANE_SIMD=avx2 ./run.sh` adds it; ...".
[[nodiscard]] std::string how_to_build(std::string_view name);

/// Instruction set of solvers made from now on: the last choice, else CHICANE_SIMD of the environment, else
/// the best one. An unavailable CHICANE_SIMD is replaced by "baseline", or by the best one if baseline is not
/// built; programs call environment_instruction_set() at their start to refuse such a CHICANE_SIMD.
[[nodiscard]] InstructionSet chosen_instruction_set() noexcept;
/// Sets the choice of the whole process; for replays and tests. Any thread. Pre: is_available(set).
void choose_instruction_set(InstructionSet set) noexcept;
/// Instruction set that CHICANE_SIMD names; if it is not set, the best one. Fails like
/// instruction_set_by_name(), and if none is available.
[[nodiscard]] Result<InstructionSet> environment_instruction_set();

/// Calls f with the tag of `set`. Sets that are not built are not compiled here, either.
/// Pre: is_available(set).
template <class F>
auto with_instructions(InstructionSet set, F&& f) {
#if defined(__x86_64__) && !defined(CHICANE_WITHOUT_AVX512)
  if (set == InstructionSet::kAvx512) return f(arch::Avx512{});
#endif
#if defined(__x86_64__) && !defined(CHICANE_WITHOUT_AVX2)
  if (set == InstructionSet::kAvx2) return f(arch::Avx2{});
#endif
#if defined(__aarch64__) && !defined(CHICANE_WITHOUT_NEON)
  if (set == InstructionSet::kNeon) return f(arch::Neon{});
#endif
  static_cast<void>(set);
  return f(arch::Simplest{});
}

}  // namespace chicane
