// SPDX-License-Identifier: MIT
#include <cstdint>

#include "traced/traced_solver.hpp"

namespace chicane::python {
namespace {

constexpr std::size_t kWide = 8, kNarrow = 2;

/// Rounded up to whole cache lines.
std::size_t padded(std::size_t doubles) { return (doubles + 7) / 8 * 8; }

void fill(const Program& program, std::size_t lanes, double* to) {
  for (const auto& [slot, value] : program.constants) {
    for (std::size_t lane = 0; lane < lanes; ++lane) to[slot * lanes + lane] = value;
  }
}

}  // namespace

Workspace::Workspace(const TracedProblem& problem) {
  std::size_t size = 16;
  const auto each = [&](const auto& visit) {
    for (std::size_t f = 0; f < kFunctions; ++f) {
      for (std::size_t order = 0; order < 3; ++order) visit(problem.programs[f][order], slots_[f][order]);
    }
  };
  each([&](const Program& program, Slots&) {
    size += padded(program.slots * kWide + 8) + padded(program.slots * kNarrow + 8);
  });
  memory_.assign(size, 0.0);
  const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
  double* next = memory_.data() + (64 - address % 64) % 64 / sizeof(double);
  each([&](const Program& program, Slots& slots) {
    slots.wide = next;
    fill(program, kWide, slots.wide);
    next += padded(program.slots * kWide + 8);
    slots.narrow = next;
    fill(program, kNarrow, slots.narrow);
    next += padded(program.slots * kNarrow + 8);
  });
}

}  // namespace chicane::python
