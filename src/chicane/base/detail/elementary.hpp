// SPDX-License-Identifier: MIT
// Elementary functions (sin, cos, atan, exp, log, …) for doubles and for packs, with the same bits for both.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"

namespace chicane::elementary {

/// Elementary functions for math.hpp (V = double) and pack.hpp (V = a pack): one text for both, without
/// branches, so that a lane has the bits of the scalar call. Plain IEEE operations in a fixed order, never
/// fused. Algorithms, coefficients and short names (r, z, w, hi, lo) are those of fdlibm 5.3 (Sun
/// Microsystems, 1993, freely distributable): e_rem_pio2.c, k_sin.c, k_cos.c, s_atan.c, e_atan2.c, e_exp.c,
/// e_log.c.

// Scalar counterparts of pack functions, by which the templates below are compiled for double.
[[nodiscard]] CHICANE_INLINE inline std::uint64_t bits_of(double x) noexcept {
  return std::bit_cast<std::uint64_t>(x);
}
[[nodiscard]] CHICANE_INLINE inline bool is_set(std::uint64_t bits) noexcept { return bits != 0; }
[[nodiscard]] CHICANE_INLINE inline double copysign(double magnitude, double sign) noexcept {
  return std::copysign(magnitude, sign);
}

/// Conversion of bits (one integer of 64 bits for each double) to a number of type V.
template <class V>
struct Number {
  using Bits = typename V::BitsType;
  CHICANE_INLINE static V from(const Bits& bits) noexcept { return V::from_bits(bits); }
};
template <>
struct Number<double> {
  using Bits = std::uint64_t;
  CHICANE_INLINE static double from(Bits bits) noexcept { return std::bit_cast<double>(bits); }
};

/// 1.5 · 2^52. The sum of this constant and a number below 2^51 has the nearest integer in its last bits.
inline constexpr double kToInteger = 6755399441055744.0;
/// Limit of |x| [rad] from which on sin and cos are NaN. Chosen: n π/2 by reduce() has lost its bits there.
inline constexpr double kMostAngle = 1e9;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An angle x as n quarter turns and a remainder.
template <class V>
struct Reduced {
  V r;                                // x − n π/2, |r| <= π/4 [rad]
  V tail;                             // rounding error of r [rad]
  typename Number<V>::Bits quadrant;  // n in the last bits
};

/// Argument reduction by Cody and Waite: subtracts n π/2, with π/2 as a sum of three parts.
template <class V>
[[nodiscard]] CHICANE_INLINE inline Reduced<V> reduce(const V& x) noexcept {
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;    // first 33 bits of π/2
  constexpr double kHalfPiMiddle = 6.07710050630396597660e-11;  // second 33 bits of π/2
  constexpr double kHalfPiLow = 2.02226624879595063154e-21;     // the rest
  constexpr double kTwoOverPi = 6.36619772367581382433e-01;
  const V counted = x * kTwoOverPi + kToInteger;
  const V n = counted - kToInteger;
  const V high = x - n * kHalfPiHigh;
  const V middle = n * kHalfPiMiddle;
  const V partial = high - middle;
  const V low = n * kHalfPiLow - ((high - partial) - middle);
  const V r = partial - low;
  return {r, (partial - r) - low, bits_of(counted)};
}

/// sin(x + tail) for |x| <= π/4, by its polynomial of degree 13.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V sin_kernel(const V& x, const V& tail) noexcept {
  constexpr double s1 = -1.66666666666666324348e-01, s2 = 8.33333333332248946124e-03,
                   s3 = -1.98412698298579493134e-04, s4 = 2.75573137070700676789e-06,
                   s5 = -2.50507602534068634195e-08, s6 = 1.58969099521155010221e-10;
  const V z = x * x;
  const V v = z * x;
  const V r = s2 + z * (s3 + z * (s4 + z * (s5 + z * s6)));
  return x - ((z * (0.5 * tail - v * r) - tail) - v * s1);
}

/// cos(x + tail) for |x| <= π/4, by its polynomial of degree 14.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V cos_kernel(const V& x, const V& tail) noexcept {
  constexpr double c1 = 4.16666666666666019037e-02, c2 = -1.38888888888741095749e-03,
                   c3 = 2.48015872894767294178e-05, c4 = -2.75573143513906633035e-07,
                   c5 = 2.08757232129817482790e-09, c6 = -1.13596475577881948265e-11;
  const V z = x * x;
  const V r = z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * c6)))));
  const V half = 0.5 * z;
  const V w = 1.0 - half;
  return w + (((1.0 - w) - half) + (z * r - x * tail));
}

/// Sine, and cosine below. Bit 0 of the quadrant exchanges the kernels of sine and cosine, bit 1 is the sign.
/// Compilers share the common work of sin and cos of one argument, which cost little more than one.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V sin(const V& x) noexcept {
  using Bits = typename Number<V>::Bits;
  const Reduced<V> a = reduce(x);
  const V s = select(is_set(a.quadrant & Bits(1)), cos_kernel(a.r, a.tail), sin_kernel(a.r, a.tail));
  const V turned = Number<V>::from(bits_of(s) ^ ((a.quadrant & Bits(2)) << 62));
  return select(abs(x) < V(kMostAngle), turned, V(kNaN));
}
template <class V>
[[nodiscard]] CHICANE_INLINE inline V cos(const V& x) noexcept {
  using Bits = typename Number<V>::Bits;
  const Reduced<V> a = reduce(x);
  const V c = select(is_set(a.quadrant & Bits(1)), sin_kernel(a.r, a.tail), cos_kernel(a.r, a.tail));
  const V turned = Number<V>::from(bits_of(c) ^ (((a.quadrant + Bits(1)) & Bits(2)) << 62));
  return select(abs(x) < V(kMostAngle), turned, V(kNaN));
}

/// Arc tangent, odd in x: atan|x| = atan(c) + atan(a) with a = (|x| − c) / (1 + c |x|), |a| < 7/16. The
/// bounds 7/16, 11/16, 19/16 and 39/16 choose c = 0, 1/2, 1, 3/2 or ∞. `high` + `low` is atan(c); `t` are the
/// coefficients of the polynomial of atan(a).
template <class V>
[[nodiscard]] CHICANE_INLINE inline V atan(const V& x) noexcept {
  constexpr double high[] = {4.63647609000806093515e-01, 7.85398163397448278999e-01,
                             9.82793723247329054082e-01, 1.57079632679489655800e+00};
  constexpr double low[] = {2.26987774529616870924e-17, 3.06161699786838301793e-17,
                            1.39033110312309984516e-17, 6.12323399573676603587e-17};
  constexpr double t[] = {
      3.33333333333329318027e-01,  -1.99999999998764832476e-01, 1.42857142725034663711e-01,
      -1.11111104054623557880e-01, 9.09088713343650656196e-02,  -7.69187620504482999495e-02,
      6.66107313738753120669e-02,  -5.83357013379057348645e-02, 4.97687799461593236017e-02,
      -3.65315727442169155270e-02, 1.62858201153657823623e-02};
  const V m = abs(x);
  const auto is_1 = m >= V(0.4375), is_2 = m >= V(0.6875), is_3 = m >= V(1.1875), is_4 = m >= V(2.4375);
  const auto choose = [&](const V& a, const V& b, const V& c, const V& d, const V& e) CHICANE_INLINE {
    return select(is_4, e, select(is_3, d, select(is_2, c, select(is_1, b, a))));
  };
  const V a = choose(m, 2.0 * m - 1.0, m - 1.0, m - 1.5, V(-1.0)) /
              choose(V(1.0), 2.0 + m, m + 1.0, 1.0 + 1.5 * m, m);
  const V start = choose(V(0.0), V(high[0]), V(high[1]), V(high[2]), V(high[3]));
  const V lost = choose(V(0.0), V(low[0]), V(low[1]), V(low[2]), V(low[3]));
  const V z = a * a;
  const V w = z * z;
  const V odd = z * (t[0] + w * (t[2] + w * (t[4] + w * (t[6] + w * (t[8] + w * t[10])))));
  const V even = w * (t[1] + w * (t[3] + w * (t[5] + w * (t[7] + w * t[9]))));
  return copysign(start - ((a * (odd + even) - lost) - a), x);
}

/// Angle of the point (x, y) in [-π, π]; 0 or ±π where y is zero, by the sign of x.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V atan2(const V& y, const V& x) noexcept {
  constexpr double pi = 3.14159265358979311600e+00, pi_low = 1.22464679914735317723e-16;
  const V zero(0.0);
  const auto on_x = (y == zero) & (x == x);  // NOLINT(misc-redundant-expression): false for NaN
  const V a = elementary::atan(abs(select(on_x, zero, y / x)));
  const auto is_behind = (copysign(V(1.0), x) < zero) & (on_x | (x < zero));
  return copysign(select(is_behind, pi - (a - pi_low), a), y);
}

/// Exponential as 2^k exp(r) with |r| <= ln 2 / 2; saturates where 2^k would leave the normal numbers.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V exp(const V& x) noexcept {
  using Bits = typename Number<V>::Bits;
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  constexpr double inverse_ln2 = 1.44269504088896338700e+00;
  constexpr double p1 = 1.66666666666666019037e-01, p2 = -2.77777777770155933842e-03,
                   p3 = 6.61375632143793436117e-05, p4 = -1.65339022054652515390e-06,
                   p5 = 4.13813679705723846039e-08;
  const V counted = x * inverse_ln2 + kToInteger;
  const V k = counted - kToInteger;
  const V hi = x - k * ln2_high;
  const V lo = k * ln2_low;
  const V r = hi - lo;
  const V t = r * r;
  const V c = r - t * (p1 + t * (p2 + t * (p3 + t * (p4 + t * p5))));
  const V y = 1.0 - ((lo - (r * c) / (2.0 - c)) - hi);
  const V power = Number<V>::from((bits_of(counted) + Bits(1023)) << 52);  // 2^k
  // 709 and -708: whole numbers just within the logarithms of normal numbers.
  return select(x > V(709.0), V(kInfinity), select(x < V(-708.0), V(0.0), y * power));
}

/// k ln 2 + log(1 + f) with 1 + f in [√½, √2].
template <class V>
[[nodiscard]] CHICANE_INLINE inline V log(const V& x) noexcept {
  using Bits = typename Number<V>::Bits;
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  constexpr double g1 = 6.666666666666735130e-01, g2 = 3.999999999940941908e-01,
                   g3 = 2.857142874366239149e-01, g4 = 2.222219843214978396e-01,
                   g5 = 1.818357216161805012e-01, g6 = 1.531383769920937332e-01,
                   g7 = 1.479819860511658591e-01;
  constexpr double kLeastNormal = std::numeric_limits<double>::min();
  constexpr double kTwo54 = 18014398509481984.0, kTwo52 = 4503599627370496.0;
  constexpr std::uint64_t kMantissa = (std::uint64_t{1} << 52) - 1;
  constexpr std::uint64_t kTwo52Bits = std::uint64_t{0x433} << 52;
  constexpr std::uint64_t kHalfBits = std::uint64_t{0x3fe} << 52;
  const auto is_tiny = x < V(kLeastNormal);
  const auto bits = bits_of(select(is_tiny, x * kTwo54, x));
  const V exponent = Number<V>::from((bits >> 52) | Bits(kTwo52Bits)) - kTwo52;
  const V fraction = Number<V>::from((bits & Bits(kMantissa)) | Bits(kHalfBits));  // value in [1/2, 1)
  const auto is_low = fraction < V(0.70710678118654752440);                        // √½
  const V m = select(is_low, 2.0 * fraction, fraction);
  const V k = exponent - select(is_tiny, V(1022.0 + 54.0), V(1022.0)) - select(is_low, V(1.0), V(0.0));
  const V f = m - 1.0;
  const V s = f / (2.0 + f);
  const V z = s * s;
  const V w = z * z;
  const V r = w * (g2 + w * (g4 + w * g6)) + z * (g1 + w * (g3 + w * (g5 + w * g7)));
  const V half = 0.5 * f * f;
  const V result = k * ln2_high - ((half - (s * (half + r) + k * ln2_low)) - f);
  const V special = select(x > V(0.0), x, select(x == V(0.0), V(-kInfinity), V(kNaN)));
  return select((x > V(0.0)) & (x < V(kInfinity)), result, special);
}

/// Hyperbolic tangent by exp; by two terms of its series for small x; ±1 from where its distance from
/// ±1 is below half an ulp.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V tanh(const V& x) noexcept {
  // Below 1e-4 the next term, 2/15 x⁵, is less than 2e-17 x; above 22 1 − tanh x is less than 2^-62.
  const V a = abs(x);
  const V e = elementary::exp(-2.0 * a);
  const V large = copysign(select(a > V(22.0), V(1.0), (1.0 - e) / (1.0 + e)), x);
  return select(a < V(1e-4), x - x * x * x / 3.0, large);
}

/// Arc sine, and arc cosine below: NaN beyond ±1.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V asin(const V& x) noexcept {
  return elementary::atan2(x, sqrt((1.0 - x) * (1.0 + x)));
}
template <class V>
[[nodiscard]] CHICANE_INLINE inline V acos(const V& x) noexcept {
  return elementary::atan2(sqrt((1.0 - x) * (1.0 + x)), x);
}

/// xⁿ by multiplication, for any sign of x and n; 1 for n = 0.
template <class V>
[[nodiscard]] CHICANE_INLINE inline V power(const V& x, int n) noexcept {
  V result(1.0);
  V square = x;
  for (unsigned rest = n < 0 ? 0U - static_cast<unsigned>(n) : static_cast<unsigned>(n); rest != 0;
       rest >>= 1U) {
    if ((rest & 1U) != 0) result = result * square;
    if (rest > 1U) square = square * square;
  }
  return n < 0 ? 1.0 / result : result;
}
/// power() for whole exponents up to ±64, else exp(exponent · log x).
template <class V>
[[nodiscard]] CHICANE_INLINE inline V pow(const V& x, double exponent) noexcept {
  constexpr double kMostFactors = 64.0;  // chosen: limit that math.hpp states for pow
  const bool is_whole = exponent >= -kMostFactors && exponent <= kMostFactors &&
                        exponent == static_cast<double>(static_cast<int>(exponent));
  if (is_whole) return elementary::power(x, static_cast<int>(exponent));
  return elementary::exp(exponent * elementary::log(x));
}

}  // namespace chicane::elementary
