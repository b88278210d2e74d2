// SPDX-License-Identifier: MIT
// Elementary functions of doubles: the templates of detail/elementary.hpp, compiled once.
#include "chicane/base/math.hpp"

#include "chicane/base/detail/elementary.hpp"

namespace chicane {

double sin(double x) noexcept { return elementary::sin(x); }
double cos(double x) noexcept { return elementary::cos(x); }
SineCosine sine_cosine(double x) noexcept { return {elementary::sin(x), elementary::cos(x)}; }
double tan(double x) noexcept { return elementary::sin(x) / elementary::cos(x); }
double atan(double x) noexcept { return elementary::atan(x); }
double atan2(double y, double x) noexcept { return elementary::atan2(y, x); }
double exp(double x) noexcept { return elementary::exp(x); }
double log(double x) noexcept { return elementary::log(x); }
double tanh(double x) noexcept { return elementary::tanh(x); }
double asin(double x) noexcept { return elementary::asin(x); }
double acos(double x) noexcept { return elementary::acos(x); }
double pow(double x, double exponent) noexcept { return elementary::pow(x, exponent); }

}  // namespace chicane
