// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "chicane/base/symbol.hpp"

namespace chicane::solver {

// Compile-time check of a user's problem (solver/problem.hpp): each mistake gives one message that says what
// to write.

struct SoftPenalty;

/// Number of entries of a row.
template <class Row>
inline constexpr int kRowSize = static_cast<int>(std::tuple_size_v<std::remove_cvref_t<Row>>);

namespace detail {

// ---- arguments for trial calls of a problem's functions

template <int... n>
auto make_symbols(std::integer_sequence<int, n...>) -> std::tuple<std::enable_if_t<n >= 0, Symbol>...>;
template <int Count>
using Symbols = decltype(make_symbols(std::make_integer_sequence<int, Count>{}));

/// Concept of functions that take variables of any types, tried with symbols. Operations that variables do
/// not have are refused here, once.
template <class P>
concept TakesSymbols = requires(const P& p, const Symbols<P::kNx>& x, const Symbols<P::kNu>& u) {
  p.dynamics(0, x, u);
  p.residual(0, x, u);
  p.terminal_residual(x);
  requires P::kNc == 0 || requires { p.constraint(0, x, u); };
};

/// Arguments and results of the functions: tuples or arrays at level 2, arrays of numbers at level 1.
template <class P, bool IsStructured>
struct RowsOf {
  using X = Symbols<P::kNx>;
  using U = Symbols<P::kNu>;
  template <class Row>
  static constexpr bool kAreRows = requires {
    std::tuple_size<Row>::value;
  };
};
template <class P>
struct RowsOf<P, false> {
  using X = std::array<double, P::kNx>;
  using U = std::array<double, P::kNu>;
  template <class Row>
  static constexpr bool kAreRows = requires(Row row) {
    requires std::tuple_size<Row>::value >= 0;
    requires std::same_as<Row, std::array<double, std::tuple_size<Row>::value>>;
  };
};
template <class P>
using Rows = RowsOf<P, TakesSymbols<P>>;

inline constexpr int kNotCallable = -1;
inline constexpr int kNoRows = -2;

/// Number of rows that one of the functions returns. `Function::call` calls it.
template <class Function, class P>
consteval int rows_of() {
  if constexpr (requires(const P& p, const typename Rows<P>::X& x, const typename Rows<P>::U& u) {
                  Function::call(p, x, u);
                }) {
    using Row = std::remove_cvref_t<decltype(Function::call(std::declval<const P&>(),
                                                            std::declval<const typename Rows<P>::X&>(),
                                                            std::declval<const typename Rows<P>::U&>()))>;
    if constexpr (Rows<P>::template kAreRows<Row>) return kRowSize<Row>;
    return kNoRows;
  } else {
    return kNotCallable;
  }
}

// ---- members of a problem

// HasMember_name<P>: whether P has a member of that name, of any kind; found by ambiguity with another of the
// same name. Call_name: the call of the function.
#define CHICANE_MEMBER(name)                                                 \
  template <class P>                                                         \
  struct HasMember_##name {                                                  \
    struct None {};                                                          \
    struct Other {                                                           \
      int name;                                                              \
    };                                                                       \
    struct Both : std::conditional_t<std::is_final_v<P>, None, P>, Other {}; \
    template <class B>                                                       \
    static constexpr bool kIsUnique = requires {                             \
      &B::name;                                                              \
    };                                                                       \
    static constexpr bool value = !kIsUnique<Both>;                          \
  };
#define CHICANE_STAGE_FUNCTION(name)                                                            \
  CHICANE_MEMBER(name)                                                                          \
  struct Call_##name {                                                                          \
    static auto call(const auto& p, const auto& x, const auto& u) -> decltype(p.name(0, x, u)); \
  };
#define CHICANE_END_FUNCTION(name)                                                      \
  CHICANE_MEMBER(name)                                                                  \
  struct Call_##name {                                                                  \
    static auto call(const auto& p, const auto& x, const auto&) -> decltype(p.name(x)); \
  };
CHICANE_STAGE_FUNCTION(dynamics)
CHICANE_STAGE_FUNCTION(residual)
CHICANE_STAGE_FUNCTION(constraint)
CHICANE_STAGE_FUNCTION(equality)
CHICANE_END_FUNCTION(terminal_residual)
CHICANE_END_FUNCTION(terminal_equality)
CHICANE_END_FUNCTION(terminal_constraint)
CHICANE_MEMBER(is_hard)
CHICANE_MEMBER(constraint_name)
CHICANE_MEMBER(constraint_unit)
CHICANE_MEMBER(input_name)
CHICANE_MEMBER(input_unit)
CHICANE_MEMBER(equality_name)
CHICANE_MEMBER(terminal_equality_name)
CHICANE_MEMBER(terminal_constraint_name)
#undef CHICANE_END_FUNCTION
#undef CHICANE_STAGE_FUNCTION
#undef CHICANE_MEMBER

// ---- checks, in the order of their messages

template <class P>
concept HasSizes = requires {
  { P::kNx } -> std::convertible_to<int>;
  { P::kNu } -> std::convertible_to<int>;
  { P::kNr } -> std::convertible_to<int>;
  { P::kNe } -> std::convertible_to<int>;
  { P::kNc } -> std::convertible_to<int>;
};
template <class P>
consteval bool check_sizes() {
  static_assert(HasSizes<P>,
                "a problem says `static constexpr int kNx = ..., kNu = ..., kNr = ..., kNe = ..., kNc = "
                "...;`: states, inputs, "
                "rows of residual(), of terminal_residual() and of constraint() (0: none)");
  if constexpr (HasSizes<P>) {
    static_assert(P::kNx > 0 && P::kNu > 0 && P::kNr >= 0 && P::kNe >= 0 && P::kNc >= 0,
                  "kNx and kNu are at least 1, kNr, kNe and kNc at least 0");
    return P::kNx > 0 && P::kNu > 0 && P::kNr >= 0 && P::kNe >= 0 && P::kNc >= 0;
  }
  return false;
}

// Functions are checked one after the other, so that a mistake in one gives no messages about others.
#define CHICANE_CHECK_FUNCTION(name, count, write)                                                         \
  template <class P>                                                                                       \
  consteval bool check_##name() {                                                                          \
    constexpr int kRows = rows_of<Call_##name, P>();                                                       \
    static_assert(kRows != kNotCallable, write);                                                           \
    static_assert(kRows == kNotCallable || kRows == P::count,                                              \
                  #name "() has to return " #count " rows: std::make_tuple(...), or std::array<T, " #count \
                        "> of arrays of T");                                                               \
    return kRows == P::count;                                                                              \
  }
#define CHICANE_STAGE(name) \
  "write `template <class K, class X, class U> auto " #name "(K k, const X& x, const U& u) const`"
#define CHICANE_END(name) "write `template <class X> auto " #name "(const X& x) const`"
CHICANE_CHECK_FUNCTION(dynamics, kNx, CHICANE_STAGE(dynamics))
CHICANE_CHECK_FUNCTION(residual, kNr, CHICANE_STAGE(residual))
CHICANE_CHECK_FUNCTION(terminal_residual, kNe, CHICANE_END(terminal_residual))
CHICANE_CHECK_FUNCTION(constraint, kNc, "kNc > 0: " CHICANE_STAGE(constraint))
// A count of 0 means that the function is not used: it may belong to another class, and is not called.
#define CHICANE_CHECK_OPTIONAL(name, count, write)                                         \
  CHICANE_CHECK_FUNCTION(name, count, #count " > 0: " write)                               \
  template <class P>                                                                       \
  consteval bool check_whether_##name() {                                                  \
    if constexpr (!requires { P::count; }) {                                               \
      static_assert(!HasMember_##name<P>::value,                                           \
                    #name "() needs its count: `static constexpr int " #count " = ...;`"); \
      return !HasMember_##name<P>::value;                                                  \
    } else if constexpr (P::count > 0) {                                                   \
      return check_##name<P>();                                                            \
    } else {                                                                               \
      return true;                                                                         \
    }                                                                                      \
  }
CHICANE_CHECK_OPTIONAL(equality, kNh, CHICANE_STAGE(equality))
CHICANE_CHECK_OPTIONAL(terminal_equality, kNeh, CHICANE_END(terminal_equality))
CHICANE_CHECK_OPTIONAL(terminal_constraint, kNec, CHICANE_END(terminal_constraint))
#undef CHICANE_CHECK_OPTIONAL
#undef CHICANE_END
#undef CHICANE_STAGE
#undef CHICANE_CHECK_FUNCTION

template <class P>
consteval bool check_bounds() {
  constexpr bool kHasBounds = requires(const P& p) {
    { p.input_lower(0) } -> std::same_as<std::array<double, P::kNu>>;
    { p.input_upper(0) } -> std::same_as<std::array<double, P::kNu>>;
  };
  static_assert(
      kHasBounds,
      "write `std::array<double, kNu> input_lower(int k) const` and the same of input_upper(int k)");
  constexpr bool kHasRate = requires(const P& p) { p.input_rate_lower(0); }
  || requires(const P& p) { p.input_rate_upper(0); };
  static_assert(!kHasRate,
                "bounds on the changes of inputs: make the change the input, and the input a state "
                "(chicane/solver/problem.hpp)");
  return kHasBounds && !kHasRate;
}

/// Whether constraints can be called on one of the levels.
template <class P>
consteval bool has_constraints() {
  if constexpr (P::kNc > 0) {
    constexpr bool kIsCallable = requires(const P& p, const Symbols<P::kNx>& x, const Symbols<P::kNu>& u) {
      p.constraint(0, x, u);
    }
    || requires(const P& p, const std::array<double, P::kNx>& x, const std::array<double, P::kNu>& u) {
      p.constraint(0, x, u);
    };
    static_assert(kIsCallable,
                  "kNc > 0: write `template <class K, class X, class U> auto constraint(K k, const X& x, "
                  "const U& u) const`");
    return kIsCallable;
  } else {
    return true;
  }
}
template <class P>
consteval bool check_constraints() {
  bool is_good = true;
  if constexpr (P::kNc > 0) {
    constexpr bool kHasPenalty = requires(const P& p) {
      { p.soft_penalty(0) } -> std::same_as<SoftPenalty>;
    };
    static_assert(kHasPenalty,
                  "kNc > 0: write `chicane::solver::SoftPenalty soft_penalty(int constraint) const`");
    is_good = check_constraint<P>() && kHasPenalty;
  }
  constexpr bool kSaysHard = requires(const P& p) {
    { p.is_hard(0) } -> std::same_as<bool>;
  };
  static_assert(kSaysHard || !HasMember_is_hard<P>::value, "write `bool is_hard(int constraint) const`");
  return is_good && (kSaysHard || !HasMember_is_hard<P>::value);
}
/// Checks names and switches, which would have no effect if their form were wrong.
template <class P>
consteval bool check_details() {
  constexpr auto kIsName = []<class Name>(std::type_identity<Name>) {
    return std::is_convertible_v<Name, std::string_view>;
  };
#define CHICANE_CHECK_NAME(name)                                                        \
  constexpr bool kIsGood_##name = [&] {                                                 \
    if constexpr (requires(const P& p) { p.name(0); })                                  \
      return kIsName(std::type_identity<decltype(std::declval<const P&>().name(0))>{}); \
    return !HasMember_##name<P>::value;                                                 \
  }();                                                                                  \
  static_assert(kIsGood_##name, "write `std::string_view " #name "(int) const`")
  CHICANE_CHECK_NAME(constraint_name);
  CHICANE_CHECK_NAME(constraint_unit);
  CHICANE_CHECK_NAME(input_name);
  CHICANE_CHECK_NAME(input_unit);
  CHICANE_CHECK_NAME(equality_name);
  CHICANE_CHECK_NAME(terminal_equality_name);
  CHICANE_CHECK_NAME(terminal_constraint_name);
#undef CHICANE_CHECK_NAME
  return kIsGood_constraint_name && kIsGood_constraint_unit && kIsGood_input_name && kIsGood_input_unit &&
         kIsGood_equality_name && kIsGood_terminal_equality_name && kIsGood_terminal_constraint_name;
}

/// Whether P is a problem. The compiler's message names what to write.
template <class P>
consteval bool is_problem() {
  if constexpr (!check_sizes<P>())
    return false;
  else if constexpr (!has_constraints<P>())
    return false;
  else if constexpr (!check_dynamics<P>())
    return false;
  else if constexpr (!check_residual<P>())
    return false;
  else if constexpr (!check_terminal_residual<P>())
    return false;
  else if constexpr (!check_bounds<P>())
    return false;
  else
    return check_constraints<P>() && check_whether_equality<P>() && check_whether_terminal_equality<P>() &&
           check_whether_terminal_constraint<P>() && check_details<P>();
}

}  // namespace detail
}  // namespace chicane::solver
