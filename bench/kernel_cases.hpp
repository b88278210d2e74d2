// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace chicane::bench {

/// The passes over the stages of one quadratic program.
enum class Kernel { kBackward, kForward };
/// The described problem's pattern, or a full one of so many states.
enum class Shape { kDescribed, kFull4, kFull6, kFull8, kFull10, kFull12 };
constexpr std::size_t kKernelStages = 20;

/// One pass over kKernelStages stages with random numbers and two inputs.
template <class Arch>
void run_kernel(Kernel kernel, Shape shape) noexcept;

/// Work of an iteration on the functions of the described problem: simulate inputs, linearise at an
/// iterate with Hessians of first or second order, and, the last part of that, turn entries into stages of
/// the quadratic program.
enum class Part { kRollOut, kFirstOrder, kSecondOrder, kSetStages };
/// The same for kKernelStages stages of the described problem.
template <class Arch>
void run_part(Part part) noexcept;

}  // namespace chicane::bench
