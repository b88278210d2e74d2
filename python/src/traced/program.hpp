// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "chicane/solver/sparse_row.hpp"
#include "traced/tape.hpp"

namespace chicane::python {

/// One operation on slots: numbers, or packs of them.
struct Instruction {
  Op op = Op::kConstant;
  std::uint32_t to = 0;
  std::uint32_t a = 0, b = 0, c = 0;
  double value = 0.0;  ///< the exponent of a power
};

/// A number from outside and where it goes.
struct Load {
  std::uint32_t slot = 0;
  std::uint32_t from = 0;  ///< variable or parameter
};

/// Slots of the results for one row.
struct ProgramRow {
  std::uint32_t value = 0;  ///< slot
  std::uint32_t slopes = 0, slope_count = 0;
  std::uint32_t curvatures = 0, curvature_count = 0;
};

/// A function as a list of operations on slots, with its derivatives up to an order. Constants have
/// slots of their own from the start; the slot of a result is kept to the end.
struct Program {
  std::vector<Instruction> code;
  std::vector<Load> variables, parameters;
  std::vector<std::uint32_t> stages;  ///< slots of the number of the stage
  std::vector<std::pair<std::uint32_t, double>> constants;
  std::vector<ProgramRow> rows;
  std::vector<solver::SparseEntry> slopes, curvatures;
  std::uint32_t slots = 0;
};

/// Order 0: values alone. The tape has the derivatives already.
[[nodiscard]] Program make_program(const Tape& tape, std::span<const std::int32_t> outputs, int order);

/// The functions of a problem, in this order.
enum class Function : std::uint8_t {
  kDynamics,
  kResidual,
  kConstraint,
  kEquality,
  kTerminalResidual,
  kTerminalEquality,
  kTerminalConstraint,
  kCount
};
inline constexpr std::size_t kFunctions = static_cast<std::size_t>(Function::kCount);
[[nodiscard]] constexpr bool is_of_stages(Function function) noexcept {
  return function < Function::kTerminalResidual;
}

/// A traced problem: its sizes and programs. Immutable; solvers on several threads share it.
struct TracedProblem {
  int nx = 0, nu = 0, np = 0;
  std::array<std::array<Program, 3>, kFunctions> programs;  ///< by function and order
  [[nodiscard]] const Program& program(Function function, int order) const {
    return programs[static_cast<std::size_t>(function)][static_cast<std::size_t>(order)];
  }
  [[nodiscard]] int rows(Function function) const {
    return static_cast<int>(program(function, 0).rows.size());
  }
};

/// Nodes in the order of their making, and the outputs of each function as numbers of nodes.
[[nodiscard]] TracedProblem make_traced_problem(
    int nx, int nu, int np, std::span<const Node> nodes,
    const std::array<std::vector<std::int32_t>, kFunctions>& outputs);

}  // namespace chicane::python
