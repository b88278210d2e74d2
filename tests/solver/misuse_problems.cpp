// SPDX-License-Identifier: MIT
// Problems that would be solved as other ones, were they not refused: what is there without its count,
// counted without being there, or written a little differently. misuse.sh compiles this file once; behind
// `expect:` stands what the compiler has to say of the line.
#include <array>
#include <string_view>
#include <tuple>

#include "chicane/solver/hard_constraints.hpp"

namespace {

/// Well-formed.
struct Base {
  static constexpr int kNx = 2, kNu = 1, kNr = 2, kNe = 2, kNc = 0;
  template <class K, class X, class U>
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [a, b] = x;
    const auto& [push] = u;
    return std::make_tuple(a + 0.1 * b, b + 0.1 * push);
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    return std::make_tuple(std::get<0>(x), 0.1 * std::get<0>(u));
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    return std::make_tuple(std::get<0>(x), std::get<1>(x));
  }
  std::array<double, 1> input_lower(int) const { return {-1.0}; }
  std::array<double, 1> input_upper(int) const { return {1.0}; }
};
/// With a soft constraint.
struct Soft : Base {
  static constexpr int kNc = 1;
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    return std::make_tuple(std::get<0>(x) - 1.0);
  }
  chicane::solver::SoftPenalty soft_penalty(int) const { return {}; }
};

struct EndWithoutCount : Base {
  template <class X>
  auto terminal_equality(const X& x) const {
    return std::make_tuple(std::get<0>(x));
  }
};
struct LimitAtEndWithoutCount : Base {
  template <class X>
  auto terminal_constraint(const X& x) const {
    return std::make_tuple(std::get<0>(x));
  }
};
struct EqualityWithoutCount : Base {
  template <class K, class X, class U>
  auto equality(K, const X& x, const U&) const {
    return std::make_tuple(std::get<0>(x));
  }
};
struct CountWithoutEnd : Base {
  static constexpr int kNeh = 1;
};
struct CountWithoutEquality : Base {
  static constexpr int kNh = 1;
};
struct CountWithoutConstraint : Base {
  static constexpr int kNc = 1;
  chicane::solver::SoftPenalty soft_penalty(int) const { return {}; }
};
/// Well-formed: says that it leaves the other's out.
struct WithoutConstraint : Soft {
  static constexpr int kNc = 0;
};
struct ConstraintTooMany : Soft {
  static constexpr int kNc = 2;
};
struct NoPenalty : Base {
  static constexpr int kNc = 1;
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    return std::make_tuple(std::get<0>(x) - 1.0);
  }
};
struct HardAsNumber : Soft {
  int is_hard(int) const { return 1; }
};
struct HardNotConst : Soft {
  bool is_hard(int) { return true; }
};
struct HardForAll : Soft {
  bool is_hard() const { return true; }
};
struct RowTooMany : Base {
  static constexpr int kNeh = 1;
  template <class X>
  auto terminal_equality(const X& x) const {
    return std::make_tuple(std::get<0>(x), std::get<1>(x));
  }
};
struct ShortResidual : Base {
  static constexpr int kNr = 3;
};
struct NoRows : Base {
  template <class X>
  auto terminal_residual(const X& x) const {
    return std::get<0>(x) + std::get<1>(x);
  }
};
struct NoSizes {
  static constexpr int kNx = 2, kNu = 1;
};
struct BoundsOnChanges : Base {
  std::array<double, 1> input_rate_lower(int) const { return {-1.0}; }
  std::array<double, 1> input_rate_upper(int) const { return {1.0}; }
};
struct DynamicsOfTwo : Base {
  template <class X, class U>
  auto dynamics(const X& x, const U&) const {
    return std::make_tuple(std::get<0>(x), std::get<1>(x));
  }
};
struct BoundOfNoStage : Base {
  std::array<double, 1> input_lower() const { return {-1.0}; }
};
struct NameOfNothing : Soft {
  std::string_view constraint_name() const { return "left edge"; }
};

template <chicane::solver::OcpProblem P>
struct Solver {};

}  // namespace

Solver<Base> base;
Solver<Soft> soft;
Solver<WithoutConstraint> without;
#ifdef MISUSE
// expect: terminal_equality() needs its count: `static constexpr int kNeh
Solver<EndWithoutCount> problem01;
// expect: terminal_constraint() needs its count: `static constexpr int kNec
Solver<LimitAtEndWithoutCount> problem02;
// expect: equality() needs its count: `static constexpr int kNh
Solver<EqualityWithoutCount> problem03;
// expect: kNeh > 0: write `template <class X> auto terminal_equality(
Solver<CountWithoutEnd> problem04;
// expect: kNh > 0: write `template <class K, class X, class U> auto equality(
Solver<CountWithoutEquality> problem05;
// expect: kNc > 0: write `template <class K, class X, class U> auto constraint(
Solver<CountWithoutConstraint> problem06;
// expect: constraint() has to return kNc rows
Solver<ConstraintTooMany> problem07;
// expect: kNc > 0: write `chicane::solver::SoftPenalty soft_penalty(int
Solver<NoPenalty> problem08;
// expect: write `bool is_hard(int constraint) const`
Solver<HardAsNumber> problem09;
// expect: write `bool is_hard(int constraint) const`
Solver<HardNotConst> problem10;
// expect: write `bool is_hard(int constraint) const`
Solver<HardForAll> problem11;
// expect: terminal_equality() has to return kNeh rows
Solver<RowTooMany> problem12;
// expect: residual() has to return kNr rows
Solver<ShortResidual> problem13;
// expect: terminal_residual() has to return kNe rows
Solver<NoRows> problem14;
// expect: a problem says `static constexpr int kNx
Solver<NoSizes> problem15;
// expect: bounds on the changes of inputs: make the change the input
Solver<BoundsOnChanges> problem16;
// expect: write `template <class K, class X, class U> auto dynamics(K k
Solver<DynamicsOfTwo> problem17;
// expect: write `std::array<double, kNu> input_lower(int k) const`
Solver<BoundOfNoStage> problem18;
// expect: write `std::string_view constraint_name(int) const`
Solver<NameOfNothing> problem19;
#endif
