// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "chicane/base/pack.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/sparse_row.hpp"
#include "traced/run_program.hpp"
#include "traced/traced_solver.hpp"

namespace chicane::python {

/// A traced problem as the solver's template wants it: its functions are programs, its sizes those of a
/// class. States and inputs beyond its own are zero and cost nothing; rows beyond its own are absent.
template <class Arch, SizeClass Sizes>
class InterpretedProblem {
 public:
  static constexpr int kNx = Sizes.nx, kNu = Sizes.nu, kNr = Sizes.nr, kNe = Sizes.ne, kNc = Sizes.nc;
  static constexpr int kNh = Sizes.nh, kNeh = Sizes.neh, kNec = Sizes.nec;
  static constexpr bool kHasSparseRows = true;
  using V = Pack<Arch, 8>;
  using One = Pack<Arch, 2>;

  const TracedProblem* problem = nullptr;
  const Workspace* workspace = nullptr;
  TracedCall call;

  template <class K, class X, std::size_t N, class U, std::size_t M>
  auto dynamics(K k, const std::array<X, N>& x, const std::array<U, M>& u) const noexcept {
    return rows<kNx, true>(Function::kDynamics, k, x, u);
  }
  template <class K, class X, std::size_t N, class U, std::size_t M>
  auto residual(K k, const std::array<X, N>& x, const std::array<U, M>& u) const noexcept {
    return rows<kNr>(Function::kResidual, k, x, u);
  }
  template <class K, class X, std::size_t N, class U, std::size_t M>
  auto constraint(K k, const std::array<X, N>& x, const std::array<U, M>& u) const noexcept {
    return rows<kNc>(Function::kConstraint, k, x, u);
  }
  template <class K, class X, std::size_t N, class U, std::size_t M>
  auto equality(K k, const std::array<X, N>& x, const std::array<U, M>& u) const noexcept {
    return rows<kNh>(Function::kEquality, k, x, u);
  }
  template <class X, std::size_t N>
  auto terminal_residual(const std::array<X, N>& x) const noexcept {
    return rows<kNe>(Function::kTerminalResidual, call.horizon, x, std::array<X, 0>{});
  }
  template <class X, std::size_t N>
  auto terminal_equality(const std::array<X, N>& x) const noexcept {
    return rows<kNeh>(Function::kTerminalEquality, call.horizon, x, std::array<X, 0>{});
  }
  template <class X, std::size_t N>
  auto terminal_constraint(const std::array<X, N>& x) const noexcept {
    return rows<kNec>(Function::kTerminalConstraint, call.horizon, x, std::array<X, 0>{});
  }

  [[nodiscard]] std::size_t constraint_count() const noexcept {
    return problem->program(Function::kConstraint, 0).rows.size();
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int c) const noexcept {
    constexpr double kNothing = 1e-12;
    if (static_cast<std::size_t>(c) >= constraint_count()) return {.linear = kNothing, .quadratic = kNothing};
    return call.penalties[c];
  }
  [[nodiscard]] bool is_hard(int c) const noexcept {
    return static_cast<std::size_t>(c) < constraint_count() && call.is_hard[c];
  }
  [[nodiscard]] std::array<double, kNu> input_lower(int k) const noexcept { return bounds(call.lower, k); }
  [[nodiscard]] std::array<double, kNu> input_upper(int k) const noexcept { return bounds(call.upper, k); }

 private:
  [[nodiscard]] std::array<double, kNu> bounds(const double* from, int k) const noexcept {
    std::array<double, kNu> result{};
    for (int m = 0; m < problem->nu; ++m) result[static_cast<std::size_t>(m)] = from[k * problem->nu + m];
    return result;
  }

  // ---- what a function is called with, as packs

  template <class T>
  struct Kind {  // a number, or one that knows the functions of models
    static constexpr int kOrder = 0;
    using Packed = One;
    using Result = T;
  };
  template <class A, std::size_t N>
  struct Kind<Pack<A, N>> {
    static constexpr int kOrder = 0;
    using Packed = Pack<A, N>;
    using Result = Pack<A, N>;
  };
  template <class T, int Order>
  struct Kind<solver::SparseSeed<T, Order>> {
    static constexpr int kOrder = Order;
    using Packed = std::conditional_t<std::is_same_v<T, double>, One, T>;
    using Result = solver::SparseRow<T>;
  };
  static One packed(double x) noexcept { return One(x); }
  static One packed(const solver::Plain& x) noexcept { return One(x.v); }
  template <std::size_t N>
  static Pack<Arch, N> packed(const Pack<Arch, N>& x) noexcept {
    return x;
  }
  template <class T, int Order>
  static auto packed(const solver::SparseSeed<T, Order>& x) noexcept {
    return packed(x.v);
  }

  template <int Count, bool IsFull = false, class K, class X, std::size_t N, class U, std::size_t M>
  auto rows(Function function, K k, const std::array<X, N>& x, const std::array<U, M>& u) const noexcept {
    using Of = Kind<X>;
    using Packed = typename Of::Packed;
    using Result = typename Of::Result;
    const Program& program = problem->program(function, Of::kOrder);
    const Slots slots = workspace->slots(function, Of::kOrder);
    double* const numbers = std::is_same_v<Packed, One> ? slots.narrow : slots.wide;
    auto* const s = reinterpret_cast<Packed*>(numbers);
    const auto nx = static_cast<std::uint32_t>(problem->nx);
    for (const Load& load : program.variables)
      s[load.slot] = load.from < nx ? packed(x[load.from]) : input(u, load.from - nx, s[load.slot]);
    for (const Load& load : program.parameters) s[load.slot] = parameter<Packed>(load.from, k);
    for (const std::uint32_t slot : program.stages) s[slot] = Packed(solver::stage_number(k));
    run_code(program.code.data(), program.code.size(), s);
    std::array<Result, Count> result;
    if constexpr (Of::kOrder == 0) {
      for (auto& row : result) row = Result(0.0);
      for (std::size_t n = 0; n < program.rows.size(); ++n)
        result[n] = result_of<Result>(s[program.rows[n].value]);
    } else {
      for (std::size_t n = 0; n < program.rows.size(); ++n)
        result[n] = row_of<Result>(program, program.rows[n], s, numbers);
      if constexpr (IsFull) {  // states that the problem does not have
        for (std::size_t n = program.rows.size(); n < result.size(); ++n)
          result[n].slots = reinterpret_cast<decltype(result[n].slots)>(numbers);
      }
    }
    return result;
  }
  template <class U, std::size_t M, class Packed>
  static Packed input(const std::array<U, M>& u, std::uint32_t m, const Packed&) noexcept {
    if constexpr (M > 0) return packed(u[m]);
    return Packed(0.0);
  }
  template <class Packed>
  Packed parameter(std::uint32_t n, int k) const noexcept {
    return Packed(call.data[n * call.data_stride + static_cast<std::size_t>(k)]);
  }
  template <class Packed>
  Packed parameter(std::uint32_t n, solver::StageLanes<V> k) const noexcept {
    return Packed::load(call.data + n * call.data_stride + k.first);
  }
  template <class Result, class Packed>
  static Result result_of(const Packed& value) noexcept {
    if constexpr (std::is_same_v<Result, Packed>) return value;
    if constexpr (!std::is_same_v<Result, Packed>) return Result(value[0]);
  }
  template <class Row, class Packed>
  static Row row_of(const Program& program, const ProgramRow& from, Packed* s, double* numbers) noexcept {
    Row row;
    row.slopes = program.slopes.data() + from.slopes;
    row.curvatures = program.curvatures.data() + from.curvatures;
    row.slope_count = from.slope_count;
    row.curvature_count = from.curvature_count;
    if constexpr (std::is_same_v<decltype(row.v), double>) {
      row.v = s[from.value][0];
      row.slots = numbers;
      row.stride = 2;
    } else {
      row.v = s[from.value];
      row.slots = s;
    }
    return row;
  }
};

}  // namespace chicane::python
