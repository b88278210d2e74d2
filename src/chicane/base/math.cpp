// SPDX-License-Identifier: MIT
#include "chicane/base/math.hpp"

#include <bit>
#include <cstdint>
#include <limits>

namespace chicane {
namespace {

constexpr double kHalfPiHigh = 1.57079632673412561417e+00;    // first 33 bits of π/2
constexpr double kHalfPiMiddle = 6.07710050630396597660e-11;  // second 33 bits of π/2
constexpr double kHalfPiLow = 2.02226624879595063154e-21;     // the rest
constexpr double kTwoOverPi = 6.36619772367581382433e-01;

struct Reduced {
  double r;     // x - n π/2, |r| <= π/4
  double tail;  // what rounding lost of r
  unsigned quadrant;
};

Reduced reduce(double x) noexcept {
  const double n = std::nearbyint(x * kTwoOverPi);
  const double high = x - n * kHalfPiHigh;
  const double middle = n * kHalfPiMiddle;
  const double partial = high - middle;
  const double low = n * kHalfPiLow - ((high - partial) - middle);
  const double r = partial - low;
  const double tail = (partial - r) - low;
  return {r, tail, static_cast<unsigned>(static_cast<std::int64_t>(n)) & 3U};
}

double sin_kernel(double x, double tail) noexcept {
  constexpr double s1 = -1.66666666666666324348e-01, s2 = 8.33333333332248946124e-03,
                   s3 = -1.98412698298579493134e-04, s4 = 2.75573137070700676789e-06,
                   s5 = -2.50507602534068634195e-08, s6 = 1.58969099521155010221e-10;
  const double z = x * x;
  const double v = z * x;
  const double r = s2 + z * (s3 + z * (s4 + z * (s5 + z * s6)));
  return x - ((z * (0.5 * tail - v * r) - tail) - v * s1);
}

double cos_kernel(double x, double tail) noexcept {
  constexpr double c1 = 4.16666666666666019037e-02, c2 = -1.38888888888741095749e-03,
                   c3 = 2.48015872894767294178e-05, c4 = -2.75573143513906633035e-07,
                   c5 = 2.08757232129817482790e-09, c6 = -1.13596475577881948265e-11;
  const double z = x * x;
  const double r = z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * c6)))));
  const double half = 0.5 * z;
  const double w = 1.0 - half;
  return w + (((1.0 - w) - half) + (z * r - x * tail));
}

bool is_out_of_range(double x) noexcept { return !(std::fabs(x) < 1e9); }

}  // namespace

double sin(double x) noexcept {
  if (is_out_of_range(x)) return std::numeric_limits<double>::quiet_NaN();
  const Reduced a = reduce(x);
  switch (a.quadrant) {
    case 0:
      return sin_kernel(a.r, a.tail);
    case 1:
      return cos_kernel(a.r, a.tail);
    case 2:
      return -sin_kernel(a.r, a.tail);
    default:
      return -cos_kernel(a.r, a.tail);
  }
}

double cos(double x) noexcept {
  if (is_out_of_range(x)) return std::numeric_limits<double>::quiet_NaN();
  const Reduced a = reduce(x);
  switch (a.quadrant) {
    case 0:
      return cos_kernel(a.r, a.tail);
    case 1:
      return -sin_kernel(a.r, a.tail);
    case 2:
      return -cos_kernel(a.r, a.tail);
    default:
      return sin_kernel(a.r, a.tail);
  }
}

double tan(double x) noexcept { return sin(x) / cos(x); }

double atan(double x) noexcept {
  constexpr double high[] = {4.63647609000806093515e-01, 7.85398163397448278999e-01,
                             9.82793723247329054082e-01, 1.57079632679489655800e+00};
  constexpr double low[] = {2.26987774529616870924e-17, 3.06161699786838301793e-17,
                            1.39033110312309984516e-17, 6.12323399573676603587e-17};
  constexpr double t[] = {
      3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
      -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
      6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
      -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  if (std::isnan(x)) return x;
  const double magnitude = std::fabs(x);
  double a = magnitude;
  int id = -1;
  if (magnitude > 1e300) return std::copysign(high[3] + low[3], x);
  if (magnitude >= 0.4375) {
    if (magnitude < 0.6875) {
      id = 0;
      a = (2.0 * a - 1.0) / (2.0 + a);
    } else if (magnitude < 1.1875) {
      id = 1;
      a = (a - 1.0) / (a + 1.0);
    } else if (magnitude < 2.4375) {
      id = 2;
      a = (a - 1.5) / (1.0 + 1.5 * a);
    } else {
      id = 3;
      a = -1.0 / a;
    }
  }
  const double z = a * a;
  const double w = z * z;
  const double odd = z * (t[0] + w * (t[2] + w * (t[4] + w * (t[6] + w * (t[8] + w * t[10])))));
  const double even = w * (t[1] + w * (t[3] + w * (t[5] + w * (t[7] + w * t[9]))));
  if (id < 0) return std::copysign(a - a * (odd + even), x);
  const double result = high[id] - ((a * (odd + even) - low[id]) - a);
  return std::copysign(result, x);
}

double atan2(double y, double x) noexcept {
  constexpr double pi = 3.14159265358979311600e+00, pi_low = 1.22464679914735317723e-16;
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0.0 && y == 0.0) return std::signbit(x) ? std::copysign(pi, y) : std::copysign(0.0, y);
  if (x == 0.0) return std::copysign(0.5 * pi, y);
  const double a = atan(std::fabs(y / x));
  const double magnitude = x > 0.0 ? a : pi - (a - pi_low);
  return std::copysign(magnitude, y);
}

double exp(double x) noexcept {
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  constexpr double inverse_ln2 = 1.44269504088896338700e+00;
  constexpr double p1 = 1.66666666666666019037e-01, p2 = -2.77777777770155933842e-03,
                   p3 = 6.61375632143793436117e-05, p4 = -1.65339022054652515390e-06,
                   p5 = 4.13813679705723846039e-08;
  if (std::isnan(x)) return x;
  if (x > 709.0) return std::numeric_limits<double>::infinity();
  if (x < -708.0) return 0.0;
  const double k = std::nearbyint(x * inverse_ln2);
  const double hi = x - k * ln2_high;
  const double lo = k * ln2_low;
  const double r = hi - lo;
  const double t = r * r;
  const double c = r - t * (p1 + t * (p2 + t * (p3 + t * (p4 + t * p5))));
  const double y = 1.0 - ((lo - (r * c) / (2.0 - c)) - hi);
  return y * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + static_cast<std::int64_t>(k)) << 52U);
}

double log(double x) noexcept {
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  constexpr double g1 = 6.666666666666735130e-01, g2 = 3.999999999940941908e-01,
                   g3 = 2.857142874366239149e-01, g4 = 2.222219843214978396e-01,
                   g5 = 1.818357216161805012e-01, g6 = 1.531383769920937332e-01,
                   g7 = 1.479819860511658591e-01;
  if (std::isnan(x) || x < 0.0) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0.0) return -std::numeric_limits<double>::infinity();
  if (std::isinf(x)) return x;
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // in [0.5, 1)
  if (m < 0.70710678118654752440) {
    m *= 2.0;
    --exponent;
  }
  const double k = exponent;
  const double f = m - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double w = z * z;
  const double r = w * (g2 + w * (g4 + w * g6)) + z * (g1 + w * (g3 + w * (g5 + w * g7)));
  const double half = 0.5 * f * f;
  return k * ln2_high - ((half - (s * (half + r) + k * ln2_low)) - f);
}

double tanh(double x) noexcept {
  if (std::isnan(x)) return x;
  const double a = std::fabs(x);
  if (a > 22.0) return std::copysign(1.0, x);
  if (a < 1e-4) return x - x * x * x / 3.0;
  const double e = exp(-2.0 * a);
  return std::copysign((1.0 - e) / (1.0 + e), x);
}

}  // namespace chicane
