// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace chicane::bench {

constexpr std::size_t kKernelStages = 20;

/// One pass over kKernelStages stages.
struct KernelCase {
  const char* name;  ///< "Backward/full8"
  void (*run)() noexcept;
};

/// Backward and forward sweeps over a quadratic program of random numbers with two inputs, of the described
/// problem's pattern and of full ones; and the work of an iteration on the functions of the described
/// problem: simulation of inputs, linearisation of first and second order, and, the last part of that, the
/// stages of the quadratic program.
template <class Arch>
[[nodiscard]] std::span<const KernelCase> kernel_cases() noexcept;

}  // namespace chicane::bench
