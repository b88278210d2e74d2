// SPDX-License-Identifier: MIT
// clang-format off
// Written by chicane (ocp.export). An optimal control problem for chicane::solver::OcpSolver<Exported_cart_pole_problem, Exported_cart_pole_problem::kHorizon>.

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <tuple>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/solver/ocp_solver.hpp"

struct Exported_cart_pole_problem {
  static constexpr int kNx = 4, kNu = 1, kNr = 5, kNe = 4, kNc = 0;
  static constexpr const char* kName = "Exported_cart_pole_problem";
  static constexpr int kHorizon = 50, kParameters = 1;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kCostOffset = 0.0;  ///< the solver's cost lacks this

  std::array<chicane::solver::StageData<kHorizon + 1>, 1> p{};  ///< p[i][k]: parameter i of stage k
  std::array<std::array<double, kNu>, kHorizon> lower{}, upper{};

  Exported_cart_pole_problem() {
    lower.fill({(-20.0)});
    upper.fill({20.0});
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics([[maybe_unused]] K k, [[maybe_unused]] const X& x, [[maybe_unused]] const U& u) const {
    using chicane::sin, chicane::cos, chicane::tan, chicane::atan, chicane::asin, chicane::acos, chicane::exp, chicane::log;
    using chicane::tanh, chicane::sqrt, chicane::pow, chicane::atan2, chicane::select;
    const auto t7 = sin(std::get<1>(x));
    const auto t8 = cos(std::get<1>(x));
    const auto t10 = 0.2 * t7;
    const auto t11 = t10 * t7;
    const auto t13 = 1.0 + t11;
    const auto t15 = 0.1 * std::get<3>(x);
    const auto t16 = t15 * std::get<3>(x);
    const auto t18 = 1.9620000000000002 * t8;
    const auto t19 = t16 + t18;
    const auto t20 = t7 * t19;
    const auto t21 = std::get<0>(u) + t20;
    const auto t22 = t21 / t13;
    const auto t24 = 0.04 * t22;
    const auto t25 = std::get<2>(x) + t24;
    const auto t26 = std::get<0>(u) * t8;
    const auto t27 = t16 * t7;
    const auto t28 = t27 * t8;
    const auto t29 = t26 + t28;
    const auto t31 = 11.772 * t7;
    const auto t32 = t29 + t31;
    const auto t34 = 0.5 * t13;
    const auto t35 = t32 / t34;
    const auto t36 = 0.04 * t35;
    const auto t37 = std::get<3>(x) - t36;
    const auto t38 = 0.04 * t25;
    const auto t39 = std::get<0>(x) + t38;
    const auto t40 = 0.04 * t37;
    const auto t41 = std::get<1>(x) + t40;
    return std::make_tuple(t39, t41, t25, t37);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual([[maybe_unused]] K k, [[maybe_unused]] const X& x, [[maybe_unused]] const U& u) const {
    using chicane::sin, chicane::cos, chicane::tan, chicane::atan, chicane::asin, chicane::acos, chicane::exp, chicane::log;
    using chicane::tanh, chicane::sqrt, chicane::pow, chicane::atan2, chicane::select;
    const auto t15 = 0.1 * std::get<3>(x);
    const auto t42 = std::get<0>(x) - p[0].at(k);
    const auto t44 = std::get<1>(x) - 3.141592653589793;
    const auto t45 = 0.1 * std::get<2>(x);
    const auto t47 = 0.05 * std::get<0>(u);
    return std::make_tuple(t42, t44, t45, t15, t47);
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual([[maybe_unused]] const X& x) const {
    using chicane::sin, chicane::cos, chicane::tan, chicane::atan, chicane::asin, chicane::acos, chicane::exp, chicane::log;
    using chicane::tanh, chicane::sqrt, chicane::pow, chicane::atan2, chicane::select;
    const auto t42 = std::get<0>(x) - p[0].at(kHorizon);
    const auto t44 = std::get<1>(x) - 3.141592653589793;
    const auto t49 = 10.0 * t42;
    const auto t51 = 30.0 * t44;
    const auto t53 = 5.0 * std::get<2>(x);
    const auto t54 = 5.0 * std::get<3>(x);
    return std::make_tuple(t49, t51, t53, t54);
  }
  [[nodiscard]] std::array<double, kNu> input_lower(int k) const { return lower[static_cast<std::size_t>(k)]; }
  [[nodiscard]] std::array<double, kNu> input_upper(int k) const { return upper[static_cast<std::size_t>(k)]; }
};

#include "chicane/solver/c_interface.hpp"

extern "C" [[gnu::visibility("default")]] const chicane_problem* cart_pole_problem(void) { return chicane::solver::c_problem<Exported_cart_pole_problem>(); }
