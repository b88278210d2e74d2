// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/detail/hard_rows.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/stage_entries.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/sparse_row.hpp"

namespace chicane::solver {

/// Value and all first derivatives of a row of a problem with many variables.
template <class V, int Count>
struct WideRow {
  static constexpr bool kIsDense = true;
  V v;
  std::array<V, static_cast<std::size_t>(Count)> slopes;
  std::array<V, 0> curvatures;
};

/// Calls the functions of a problem for eight stages and returns jets over packs. Structured problems are
/// called with lanes and a type for each variable, problems whose functions take lanes of one type with that
/// type, all others stage by stage.
template <OcpProblem P, class Arch>
class Evaluation {
 public:
  using V = Stages<Arch>;
  static constexpr int kNx = P::kNx;
  static constexpr int kNu = P::kNu;
  static constexpr int kNc = P::kNc;
  static constexpr int kVariables = kNx + kNu;
  static constexpr bool kIsStructured = StructuredProblem<P>;
  /// One stage as a value: a pack of equal lanes, so that its code carries the tag of the instruction set;
  /// for functions that may branch a number that knows the functions of models.
  using One = std::conditional_t<kIsStructured, Pack<Arch, 2>, Plain>;
  /// Scalar for values and derivatives of terminal residuals.
  using EndValue = std::conditional_t<kIsStructured, Pack<Arch, 2>, double>;

  /// Results of the functions of a stage.
  template <class Next, class Residual, class Constraint>
  struct StageRows {
    Next next;
    Residual residual;
    Constraint constraint;
  };
  template <class N, class R, class C>
  StageRows(N, R, C) -> StageRows<N, R, C>;

  /// Functions of the stages k0 … k0 + 7 with derivatives up to Order.
  template <int Order, class Point>
  CHICANE_INLINE static auto stages(const P& problem, const Point& t, std::size_t k0) noexcept {
    if constexpr (kIsSparse) {
      return evaluate<Order>(problem, StageLanes<V>{static_cast<int>(k0)}, sparse<V, Order, kNx>(t.x, k0),
                             sparse<V, Order, kNu>(t.u, k0));
    } else if constexpr (kIsLarge) {
      return in_blocks(problem, t, k0);
    } else if constexpr (kIsStructured) {
      return evaluate<Order>(problem, StageLanes<V>{static_cast<int>(k0)}, seeds<Order, 0, kNx>(t.x, k0),
                             seeds<Order, kNx, kNu>(t.u, k0));
    } else if constexpr (kTakesLanes) {
      return evaluate<Order>(problem, StageLanes<V>{static_cast<int>(k0)}, dense<V, Order, 0, kNx>(t.x, k0),
                             dense<V, Order, kNx, kNu>(t.u, k0));
    } else {
      return one_by_one<Order>(problem, t, k0);
    }
  }

  /// x_{k+1} of one stage.
  static std::array<One, P::kNx> next(const P& problem, std::size_t k, const std::array<One, P::kNx>& x,
                                      const std::array<One, P::kNu>& u) noexcept {
    return to_array<One>(problem.dynamics(static_cast<int>(k), x, u));
  }

  /// Residuals that represent hard rows.
  static constexpr std::size_t kHardRows = static_cast<std::size_t>(P::kNr) - own_residuals<P>();
  /// Values of one stage, or of one in each lane, without derivatives, for a line search.
  template <class T>
  struct ValuesOf {
    T cost;                         ///< ½‖r‖² of the problem's own residuals
    std::array<T, kHardRows> hard;  ///< residuals of hard rows
    std::array<T, kNc> constraint;  ///< soft constraints
    std::array<T, kNx> next;        ///< x_{k+1}
  };
  using Values = ValuesOf<V>;
  /// Values of the stages k0 … k0 + 7.
  template <class Point>
  static Values values(const P& problem, const Point& t, std::size_t k0) noexcept {
    if constexpr (kIsStructured || kTakesLanes) {
      std::array<V, kNx> x;
      std::array<V, kNu> u;
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = V::load(t.x[i] + k0);
      for (std::size_t m = 0; m < u.size(); ++m) u[m] = V::load(t.u[m] + k0);
      return values_of<V>(problem, StageLanes<V>{static_cast<int>(k0)}, x, u);
    } else {
      alignas(64) double numbers[1 + kHardRows + kNc + kNx][8] = {};
      for (std::size_t lane = 0; lane < 8 && k0 + lane < t.horizon; ++lane) {
        const auto one = values_of<One>(problem, static_cast<int>(k0 + lane),
                                        t.template state<One>(k0 + lane), t.template input<One>(k0 + lane));
        std::size_t at = 0;
        numbers[at++][lane] = number(one.cost);
        for (const One& h : one.hard) numbers[at++][lane] = number(h);
        for (const One& c : one.constraint) numbers[at++][lane] = number(c);
        for (const One& next : one.next) numbers[at++][lane] = number(next);
      }
      Values result;
      std::size_t at = 0;
      result.cost = V::load(numbers[at++]);
      for (V& h : result.hard) h = V::load(numbers[at++]);
      for (V& c : result.constraint) c = V::load(numbers[at++]);
      for (V& next : result.next) next = V::load(numbers[at++]);
      return result;
    }
  }
  /// ½‖r‖² of the end. With `hard` only the problem's own residuals count; `hard` gets those of hard rows.
  template <class Point>
  static double end_cost(const P& problem, const Point& t, double* hard = nullptr) noexcept {
    double sum = 0.0;
    std::size_t own = static_cast<std::size_t>(P::kNe);
    if constexpr (kHasHardRows<P>) own = hard != nullptr ? static_cast<std::size_t>(P::kOwnEnd) : own;
    const auto residuals = to_array<One>(problem.terminal_residual(t.template state<One>(t.horizon)));
    for (std::size_t n = 0; n < residuals.size(); ++n) {
      const double r = number(residuals[n]);
      if (n < own) {
        sum += 0.5 * r * r;
      } else {
        hard[n - own] = r;
      }
    }
    return sum;
  }

  /// Largest violation of a soft constraint along `t`; 0 when all are kept.
  template <class Point>
  static double violation([[maybe_unused]] const P& problem, [[maybe_unused]] const Point& t) noexcept {
    double worst = 0.0;
    if constexpr (kNc > 0) {
      for (std::size_t k = 0; k < t.horizon; ++k) {
        const auto values = to_array<One>(
            problem.constraint(static_cast<int>(k), t.template state<One>(k), t.template input<One>(k)));
        for (const One& value : values) worst = number(value) > worst ? number(value) : worst;
      }
    }
    return worst;
  }

  /// Terminal residuals with derivatives up to Order; number() gives their values.
  template <int Order, class Point>
  static auto end(const P& problem, const Point& t) noexcept {
    if constexpr (kIsSparse) {
      return problem.terminal_residual(sparse<double, Order, kNx>(t.x, t.horizon));
    } else if constexpr (kIsLarge) {
      Rows<double, P::kNe> rows;
      blocks<double>([&](int begin, auto seed) {
        put(problem.terminal_residual(seed.template operator()<0, kNx>(t.x, t.horizon)), begin, rows);
      });
      return rows;
    } else if constexpr (kIsStructured) {
      StateJets<P, EndValue, Order> x;
      jet::repeat<kNx>([&](auto i) CHICANE_INLINE { std::get<i>(x).v = EndValue(t.x[i][t.horizon]); });
      return problem.terminal_residual(x);
    } else {
      return problem.terminal_residual(dense<EndValue, Order, 0, kNx>(t.x, t.horizon));
    }
  }
  CHICANE_INLINE static double number(double x) noexcept { return x; }
  CHICANE_INLINE static double number(const Plain& x) noexcept { return x.v; }
  template <std::size_t N>
  CHICANE_INLINE static double number(const Pack<Arch, N>& x) noexcept {
    return x[0];
  }

 private:
  static constexpr bool kIsSparse = kHasSparseRows<P>;
  /// Whether the variables are so many that derivatives are evaluated by blocks of variables.
  static constexpr bool kIsLarge = kVariables > static_cast<int>(kMostUnrolled);
  static constexpr int kBlocks = kIsLarge ? (kVariables + 15) / 16 : 1;
  static constexpr int kBlock = (kVariables + kBlocks - 1) / kBlocks;
  template <class T>
  using BlockJet = Jet<T, 1, first_variables(kBlock)>;

  template <class T, int Order>
  struct DenseOf {
    using Type = DenseJet<P, T, Order>;
  };
  template <class T, int Order>
  requires(Order >= 0 && kIsLarge) struct DenseOf<T, Order> {
    using Type = BlockJet<T>;
  };
  /// Least number of variables for jets that skip zeros. Jets of fewer fit the registers, and computing their
  /// zeros is quicker.
  static constexpr int kFewestLoose = 5;
  template <class T, int Order>
  requires(Order == 2 && !kIsLarge && kVariables >= kFewestLoose &&
           !std::is_same_v<T, double>) struct DenseOf<T, Order> {
    using Type = LooseJet<T, kVariables>;
  };
  template <class T, int Order>
  using Dense = typename DenseOf<T, Order>::Type;
  static constexpr bool takes_lanes() noexcept {
    if constexpr (kIsSparse) {
      return true;
    } else {
      return !kIsStructured && requires(const P& p, StageLanes<V> k, const std::array<Dense<V, 1>, kNx>& x,
                                        const std::array<Dense<V, 1>, kNu>& u) {
        p.dynamics(k, x, u);
        p.residual(k, x, u);
        requires kNc == 0 || requires { p.constraint(k, x, u); };
      };
    }
  }
  static constexpr bool kTakesLanes = takes_lanes();
  static_assert(
      kIsSparse || !kIsLarge || (kTakesLanes && !has_hessians<P>()),
      "more than 24 variables in a stage: functions over arrays of one scalar type, with `class K` for "
      "the stage, and kGaussNewton = true");

  template <class T, int Count>
  using Rows = std::array<WideRow<T, kVariables>, static_cast<std::size_t>(Count)>;
  /// Calls visit(begin, seed) for each block of variables; seed<Begin, Count>(values, k0): variables Begin …
  /// as jets over it.
  template <class T, class Visit>
  static void blocks(const Visit& visit) noexcept {
    for (int begin = 0; begin < kVariables; begin += kBlock) {
      visit(begin, [begin]<int Begin, int Count, class Values>(const Values& values, std::size_t k0) {
        std::array<BlockJet<T>, static_cast<std::size_t>(Count)> result;
        for (int n = 0; n < Count; ++n) {
          auto& jet = result[static_cast<std::size_t>(n)];
          if constexpr (std::is_same_v<T, double>) {
            jet = BlockJet<T>(values[n][k0]);
          } else {
            jet = BlockJet<T>(T::load(values[n] + k0));
          }
          const int at = Begin + n - begin;
          if (at >= 0 && at < kBlock) jet.slopes[static_cast<std::size_t>(at)] = T(1.0);
        }
        return result;
      });
    }
  }
  /// Places a function's result among the variables from `begin` on.
  template <class T, std::size_t Count>
  static void put(const std::array<BlockJet<T>, Count>& from, int begin,
                  std::array<WideRow<T, kVariables>, Count>& rows) noexcept {
    for (std::size_t i = 0; i < Count; ++i) {
      rows[i].v = from[i].v;
      for (int j = 0; j < kBlock && begin + j < kVariables; ++j)
        rows[i].slopes[static_cast<std::size_t>(begin + j)] = from[i].slopes[static_cast<std::size_t>(j)];
    }
  }
  /// Rows of the stages k0 … k0 + 7 by one call for each block of variables.
  template <class Point>
  static auto in_blocks(const P& problem, const Point& t, std::size_t k0) noexcept {
    StageRows<Rows<V, kNx>, Rows<V, P::kNr>, Rows<V, kNc>> all;
    blocks<V>([&](int begin, auto seed) {
      const StageLanes<V> k{static_cast<int>(k0)};
      const auto x = seed.template operator()<0, kNx>(t.x, k0);
      const auto u = seed.template operator()<kNx, kNu>(t.u, k0);
      put(problem.dynamics(k, x, u), begin, all.next);
      put(problem.residual(k, x, u), begin, all.residual);
      if constexpr (kNc > 0) put(problem.constraint(k, x, u), begin, all.constraint);
    });
    return all;
  }

  /// Values of stage k, or of one stage in each lane.
  template <class T, class K>
  static ValuesOf<T> values_of(const P& problem, K k, const std::array<T, kNx>& x,
                               const std::array<T, kNu>& u) noexcept {
    ValuesOf<T> values{T(0.0), {}, {}, to_array<T>(problem.dynamics(k, x, u))};
    const auto residuals = to_array<T>(problem.residual(k, x, u));
    for (std::size_t n = 0; n < own_residuals<P>(); ++n) values.cost += residuals[n] * residuals[n];
    for (std::size_t n = 0; n < kHardRows; ++n) values.hard[n] = residuals[own_residuals<P>() + n];
    values.cost = 0.5 * values.cost;
    if constexpr (kNc > 0) values.constraint = to_array<T>(problem.constraint(k, x, u));
    return values;
  }

  /// Results of the functions for variables of any type.
  template <int Order, class K, class X, class U>
  CHICANE_INLINE static auto evaluate(const P& problem, K k, const X& x, const U& u) noexcept {
    if constexpr (kNc > 0) {
      return StageRows{problem.dynamics(k, x, u), problem.residual(k, x, u), problem.constraint(k, x, u)};
    } else {
      return StageRows{problem.dynamics(k, x, u), problem.residual(k, x, u), std::tuple<>{}};
    }
  }

  /// Variables of a structured problem, each of its own type.
  template <int Order, int Begin, int Count, class Values>
  CHICANE_INLINE static auto seeds(const Values& values, std::size_t k0) noexcept {
    detail::Seeds<V, Order, Begin, Count> result;
    jet::repeat<Count>([&](auto n) CHICANE_INLINE { std::get<n>(result).v = V::load(values[n] + k0); });
    return result;
  }
  /// Variables of a problem whose rows name their own dependencies.
  template <class T, int Order, int Count, class Values>
  CHICANE_INLINE static auto sparse(const Values& values, std::size_t k0) noexcept {
    std::array<SparseSeed<T, Order>, static_cast<std::size_t>(Count)> result;
    for (std::size_t n = 0; n < static_cast<std::size_t>(Count); ++n) {
      if constexpr (std::is_same_v<T, double>) result[n].v = values[n][k0];
      if constexpr (!std::is_same_v<T, double>) result[n].v = T::load(values[n] + k0);
    }
    return result;
  }
  /// Variables of one type that stores all derivatives.
  template <class T, int Order, int Begin, int Count, class Values>
  CHICANE_INLINE static auto dense(const Values& values, std::size_t k0) noexcept {
    std::array<Dense<T, Order>, static_cast<std::size_t>(Count)> result;
    for (std::size_t n = 0; n < static_cast<std::size_t>(Count); ++n) {
      if constexpr (AnyLooseJet<Dense<T, Order>>) {
        result[n] = Dense<T, Order>::variable(T::load(values[n] + k0), Begin + static_cast<int>(n));
        continue;
      } else if constexpr (std::is_same_v<T, double>) {
        result[n] = Dense<T, Order>(values[n][k0]);
      } else {
        result[n] = Dense<T, Order>(T::load(values[n] + k0));
      }
      result[n].slopes[static_cast<std::size_t>(Begin) + n] = T(1.0);
    }
    return result;
  }

  /// Rows of jets over packs, gathered from eight calls.
  template <int Order, std::size_t Count>
  struct Gathered {
    static constexpr std::size_t kNumbers =
        1 + Dense<double, Order>::kSlopes + Dense<double, Order>::kCurvatures;
    alignas(64) double numbers[Count > 0 ? Count : 1][kNumbers][8] = {};

    void put(std::size_t lane, const std::array<Dense<double, Order>, Count>& row) noexcept {
      for (std::size_t i = 0; i < Count; ++i) {
        std::size_t at = 0;
        numbers[i][at++][lane] = row[i].v;
        for (const double d : row[i].slopes) numbers[i][at++][lane] = d;
        for (const double d : row[i].curvatures) numbers[i][at++][lane] = d;
      }
    }
    [[nodiscard]] std::array<DenseJet<P, V, Order>, Count> rows() const noexcept {
      std::array<DenseJet<P, V, Order>, Count> result;
      for (std::size_t i = 0; i < Count; ++i) {
        std::size_t at = 0;
        result[i].v = V::load(numbers[i][at++]);
        for (V& d : result[i].slopes) d = V::load(numbers[i][at++]);
        for (V& d : result[i].curvatures) d = V::load(numbers[i][at++]);
      }
      return result;
    }
  };

  /// Rows of the stages k0 … k0 + 7 by one call for each stage.
  template <int Order, class Point>
  static auto one_by_one(const P& problem, const Point& t, std::size_t k0) noexcept {
    Gathered<Order, static_cast<std::size_t>(kNx)> next;
    Gathered<Order, static_cast<std::size_t>(P::kNr)> residual;
    Gathered<Order, static_cast<std::size_t>(kNc)> constraint;
    for (std::size_t lane = 0; lane < 8 && k0 + lane < t.horizon; ++lane) {
      const int k = static_cast<int>(k0 + lane);
      const auto x = dense<double, Order, 0, kNx>(t.x, k0 + lane);
      const auto u = dense<double, Order, kNx, kNu>(t.u, k0 + lane);
      next.put(lane, problem.dynamics(k, x, u));
      residual.put(lane, problem.residual(k, x, u));
      if constexpr (kNc > 0) constraint.put(lane, problem.constraint(k, x, u));
    }
    return StageRows{next.rows(), residual.rows(), constraint.rows()};
  }
};

}  // namespace chicane::solver
