// SPDX-License-Identifier: MIT
// Mask, Bits and Pack: several doubles that one instruction works on at once, used like plain numbers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "chicane/base/compiler.hpp"
#include "chicane/base/detail/elementary.hpp"
#include "chicane/base/detail/instructions.hpp"

namespace chicane {

/// A truth value for each of N lanes: the result of a comparison of packs.
template <class Arch, std::size_t N>
struct Mask {
  static constexpr std::size_t kWidth = N < Arch::kWidth ? N : Arch::kWidth;  ///< lanes in a register
  static constexpr std::size_t kParts = N / kWidth;                           ///< registers
  using Ops = pack_detail::Ops<Arch, kWidth>;
  typename Ops::Mask part[kParts];

  // clang-format off: compilers show the comment
  operator bool() const = delete;  // NOLINT  several answers at once: write select(x > 1.0, a, b), max(a, b),
                                   // min or abs instead of if, ?:, && and ||
  // clang-format on

  /// Mask that is set in the first `count` lanes.
  CHICANE_INLINE static Mask first(std::size_t count) noexcept {
    struct {
      typename Ops::Integer part[kParts];
    } lane;
    for (std::size_t i = 0; i < N; ++i) lane.part[i / kWidth][i % kWidth] = i < count ? -1 : 0;
    return pack_detail::by_parts<Ops::from_bits, Mask>(lane);
  }
  /// The mask as a number: bit i is lane i.
  [[nodiscard]] CHICANE_INLINE unsigned bits() const noexcept {
    unsigned result = 0;
    for (std::size_t p = 0; p < kParts; ++p) result |= Ops::bits(part[p]) << (p * kWidth);
    return result;
  }
  [[nodiscard]] CHICANE_INLINE bool operator[](std::size_t lane) const noexcept {
    return ((bits() >> lane) & 1U) != 0;
  }
  CHICANE_INLINE friend bool any(const Mask& m) noexcept { return m.bits() != 0; }
  CHICANE_INLINE friend bool all(const Mask& m) noexcept { return m.bits() == (1U << N) - 1U; }
  CHICANE_INLINE friend Mask operator&(const Mask& a, const Mask& b) noexcept {
    return pack_detail::by_parts<Ops::both, Mask>(a, b);
  }
  CHICANE_INLINE friend Mask operator|(const Mask& a, const Mask& b) noexcept {
    return pack_detail::by_parts<Ops::either, Mask>(a, b);
  }
  CHICANE_INLINE friend Mask operator!(const Mask& a) noexcept {
    return pack_detail::by_parts<Ops::inverse, Mask>(a);
  }
};

/// The 64 bits of each lane as an integer, for branch-free elementary functions.
template <class Arch, std::size_t N>
struct Bits {
  static constexpr std::size_t kWidth = N < Arch::kWidth ? N : Arch::kWidth;  ///< lanes in a register
  static constexpr std::size_t kParts = N / kWidth;                           ///< registers
  using Ops = pack_detail::Ops<Arch, kWidth>;
  typename Ops::Integer part[kParts];

  Bits() noexcept = default;
  CHICANE_INLINE Bits(std::int64_t value) noexcept {  // NOLINT: constants mix freely, as in formulas
    for (auto& p : part) p = typename Ops::Integer{} + value;
  }
  CHICANE_INLINE friend Bits operator&(const Bits& a, const Bits& b) noexcept {
    return each<Ops::integer_and>(a, b);
  }
  CHICANE_INLINE friend Bits operator|(const Bits& a, const Bits& b) noexcept {
    return each<Ops::integer_or>(a, b);
  }
  CHICANE_INLINE friend Bits operator^(const Bits& a, const Bits& b) noexcept {
    return each<Ops::integer_xor>(a, b);
  }
  CHICANE_INLINE friend Bits operator+(const Bits& a, const Bits& b) noexcept {
    return each<Ops::integer_add>(a, b);
  }
  CHICANE_INLINE friend Bits operator-(const Bits& a, const Bits& b) noexcept {
    return each<Ops::integer_subtract>(a, b);
  }
  CHICANE_INLINE friend Bits operator<<(const Bits& a, int count) noexcept {
    Bits r;
    for (std::size_t p = 0; p < kParts; ++p) r.part[p] = Ops::shift_left(a.part[p], count);
    return r;
  }
  /// Shifts right; fills with zeros from the left.
  CHICANE_INLINE friend Bits operator>>(const Bits& a, int count) noexcept {
    Bits r;
    for (std::size_t p = 0; p < kParts; ++p) r.part[p] = Ops::shift_right(a.part[p], count);
    return r;
  }
  /// Lanes that are not zero.
  CHICANE_INLINE friend Mask<Arch, N> is_set(const Bits& a) noexcept {
    return pack_detail::by_parts<Ops::from_bits, Mask<Arch, N>>(a);
  }

 private:
  template <auto Op>
  CHICANE_INLINE static Bits each(const Bits& a, const Bits& b) noexcept {
    return pack_detail::by_parts<Op, Bits>(a, b);
  }
};

/// N doubles (2, 4, 8 or 16), the lanes, in one or several registers of the instruction set `Arch`. Every
/// operation works lane by lane and rounds by IEEE 754, so that results do not depend on the width of
/// registers. Avx2, Avx512 and Neon have a fused multiply-add and give the same bits ("fused"); Baseline has
/// none and gives others ("plain").
///
/// Templates over any scalar take a Pack: it has arithmetic, comparison (to a Mask), select, min, max, abs
/// and sqrt. A default-constructed Pack is not initialised.
template <class Arch, std::size_t N>
struct Pack {
  static constexpr std::size_t kLanes = N;
  static constexpr std::size_t kWidth = N < Arch::kWidth ? N : Arch::kWidth;  ///< lanes in a register
  static constexpr std::size_t kParts = N / kWidth;                           ///< registers
  using Instructions = Arch;
  using Ops = pack_detail::Ops<Arch, kWidth>;
  using Real = typename Ops::Real;
  using MaskType = Mask<Arch, N>;
  using BitsType = Bits<Arch, N>;
  Real part[kParts];

  Pack() noexcept = default;
  CHICANE_INLINE Pack(double value) noexcept {  // NOLINT: constants mix freely with packs, as in formulas
    for (auto& p : part) {
      if constexpr (kWidth == 2) {
        p = Real{value, value};
      } else if constexpr (kWidth == 4) {
        p = Real{value, value, value, value};
      } else {
        p = Real{value, value, value, value, value, value, value, value};
      }
    }
  }
  /// Loads N doubles from an address that is a multiple of 8 N bytes.
  CHICANE_INLINE static Pack load(const double* from) noexcept {
    Pack r;
    for (std::size_t p = 0; p < kParts; ++p) r.part[p] = Memory::load(from + p * kWidth);
    return r;
  }
  CHICANE_INLINE static Pack load_unaligned(const double* from) noexcept {
    Pack r;
    for (std::size_t p = 0; p < kParts; ++p) r.part[p] = Memory::load_unaligned(from + p * kWidth);
    return r;
  }
  CHICANE_INLINE void store(double* to) const noexcept {
    for (std::size_t p = 0; p < kParts; ++p) Memory::store(to + p * kWidth, part[p]);
  }
  CHICANE_INLINE void store_unaligned(double* to) const noexcept {
    for (std::size_t p = 0; p < kParts; ++p) Memory::store_unaligned(to + p * kWidth, part[p]);
  }
  /// The pack 0, 1, 2, … N − 1.
  CHICANE_INLINE static Pack iota() noexcept {
    Pack r;
    for (std::size_t i = 0; i < N; ++i) r.set(i, static_cast<double>(i));
    return r;
  }
  [[nodiscard]] CHICANE_INLINE double operator[](std::size_t lane) const noexcept {
    return part[lane / kWidth][lane % kWidth];
  }
  CHICANE_INLINE void set(std::size_t lane, double value) noexcept {
    part[lane / kWidth][lane % kWidth] = value;
  }

  CHICANE_INLINE friend Pack operator+(const Pack& a, const Pack& b) noexcept { return each<Ops::add>(a, b); }
  CHICANE_INLINE friend Pack operator-(const Pack& a, const Pack& b) noexcept {
    return each<Ops::subtract>(a, b);
  }
  CHICANE_INLINE friend Pack operator*(const Pack& a, const Pack& b) noexcept {
    return each<Ops::multiply>(a, b);
  }
  CHICANE_INLINE friend Pack operator/(const Pack& a, const Pack& b) noexcept {
    return each<Ops::divide>(a, b);
  }
  CHICANE_INLINE friend Pack operator-(const Pack& a) noexcept { return each<Ops::negate>(a); }
  CHICANE_INLINE Pack& operator+=(const Pack& o) noexcept { return *this = *this + o; }
  CHICANE_INLINE Pack& operator-=(const Pack& o) noexcept { return *this = *this - o; }
  CHICANE_INLINE Pack& operator*=(const Pack& o) noexcept { return *this = *this * o; }
  CHICANE_INLINE Pack& operator/=(const Pack& o) noexcept { return *this = *this / o; }

  CHICANE_INLINE friend MaskType operator<(const Pack& a, const Pack& b) noexcept {
    return compare<Ops::less>(a, b);
  }
  CHICANE_INLINE friend MaskType operator<=(const Pack& a, const Pack& b) noexcept {
    return compare<Ops::less_equal>(a, b);
  }
  CHICANE_INLINE friend MaskType operator>(const Pack& a, const Pack& b) noexcept { return b < a; }
  CHICANE_INLINE friend MaskType operator>=(const Pack& a, const Pack& b) noexcept { return b <= a; }
  CHICANE_INLINE friend MaskType operator==(const Pack& a, const Pack& b) noexcept {
    return compare<Ops::equal>(a, b);
  }

  /// a · b + c, rounded once if Arch::kFused, else twice.
  CHICANE_INLINE friend Pack fused_multiply_add(const Pack& a, const Pack& b, const Pack& c) noexcept {
    return each<Ops::fused_multiply_add>(a, b, c);
  }
  /// c − a · b, rounded once if Arch::kFused, else twice.
  CHICANE_INLINE friend Pack fused_negative_multiply_add(const Pack& a, const Pack& b,
                                                         const Pack& c) noexcept {
    return each<Ops::fused_negative_multiply_add>(a, b, c);
  }
  CHICANE_INLINE friend Pack select(const MaskType& m, const Pack& a, const Pack& b) noexcept {
    return each<Ops::select>(m, a, b);
  }
  /// min is a < b ? a : b, max is a > b ? a : b: the second one in lanes where an argument is not a number.
  CHICANE_INLINE friend Pack min(const Pack& a, const Pack& b) noexcept { return each<Ops::min>(a, b); }
  CHICANE_INLINE friend Pack max(const Pack& a, const Pack& b) noexcept { return each<Ops::max>(a, b); }
  CHICANE_INLINE friend Pack sqrt(const Pack& a) noexcept { return each<Ops::sqrt>(a); }
  /// Rounds to the nearest integer, ties to even.
  CHICANE_INLINE friend Pack round(const Pack& a) noexcept { return each<Ops::round>(a); }
  CHICANE_INLINE friend BitsType bits_of(const Pack& a) noexcept {
    return pack_detail::by_parts<Ops::to_bits, BitsType>(a);
  }
  CHICANE_INLINE static Pack from_bits(const BitsType& a) noexcept { return each<Ops::to_real>(a); }
  CHICANE_INLINE friend Pack abs(const Pack& a) noexcept {
    return from_bits(bits_of(a) & BitsType(INT64_MAX));
  }
  CHICANE_INLINE friend Pack copysign(const Pack& magnitude, const Pack& sign) noexcept {
    return from_bits((bits_of(magnitude) & BitsType(INT64_MAX)) | (bits_of(sign) & BitsType(INT64_MIN)));
  }
  /// Lanes that are finite.
  CHICANE_INLINE friend MaskType is_finite(const Pack& a) noexcept { return a - a == Pack(0.0); }
  /// Sum of the lanes, by halves, so that the order of additions does not depend on registers.
  CHICANE_INLINE friend double sum(const Pack& a) noexcept {
    return reduce(a, [](double x, double y) CHICANE_INLINE { return x + y; });
  }
  CHICANE_INLINE friend double largest(const Pack& a) noexcept {
    return reduce(a, [](double x, double y) CHICANE_INLINE { return x > y ? x : y; });
  }

 private:
  using Memory = pack_detail::Lanes<kWidth>;
  template <auto Op, class... Operands>
  CHICANE_INLINE static Pack each(const Operands&... operands) noexcept {
    return pack_detail::by_parts<Op, Pack>(operands...);
  }
  template <auto Op>
  CHICANE_INLINE static MaskType compare(const Pack& a, const Pack& b) noexcept {
    return pack_detail::by_parts<Op, MaskType>(a, b);
  }
  /// One number from all lanes: op(first half, second half), until one lane is left.
  template <class Op>
  CHICANE_INLINE static double reduce(const Pack& a, Op op) noexcept {
    double value[N];
    a.store_unaligned(value);
    for (std::size_t half = N / 2; half > 0; half /= 2) {
      for (std::size_t i = 0; i < half; ++i) value[i] = op(value[i], value[i + half]);
    }
    return value[0];
  }
};

/// The common value of a pack whose lanes are equal.
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline double value_of(const Pack<Arch, N>& x) noexcept {
  return x[0];
}

/// Transposes N packs of N lanes, each a row, block by block of the size of a register.
template <class Arch, std::size_t N>
CHICANE_INLINE inline void transpose(Pack<Arch, N> (&row)[N]) noexcept {
  using P = Pack<Arch, N>;
  constexpr std::size_t kW = P::kWidth;
  typename P::Real block[P::kParts][P::kParts][kW];
  unroll<P::kParts * P::kParts>([&](auto b) CHICANE_INLINE {
    constexpr std::size_t kRow = b / P::kParts;
    constexpr std::size_t kColumn = b % P::kParts;
    unroll<kW>([&](auto r) CHICANE_INLINE { block[kRow][kColumn][r] = row[kRow * kW + r].part[kColumn]; });
    pack_detail::transpose_block<kW>(block[kRow][kColumn]);
  });
  unroll<P::kParts * P::kParts>([&](auto b) CHICANE_INLINE {
    constexpr std::size_t kRow = b / P::kParts;
    constexpr std::size_t kColumn = b % P::kParts;
    unroll<kW>([&](auto r) CHICANE_INLINE { row[kRow * kW + r].part[kColumn] = block[kColumn][kRow][r]; });
  });
}

/// a · b + c for plain numbers, with the rounding of a Pack of `Arch`: templates are written once for both.
template <class Arch>
[[nodiscard]] CHICANE_INLINE inline double fused_multiply_add(double a, double b, double c) noexcept {
  if constexpr (Arch::kFused) return __builtin_fma(a, b, c);
  return a * b + c;
}
/// c − a · b for plain numbers, with the rounding of a Pack of `Arch`.
template <class Arch>
[[nodiscard]] CHICANE_INLINE inline double fused_negative_multiply_add(double a, double b,
                                                                       double c) noexcept {
  if constexpr (Arch::kFused) return __builtin_fma(-a, b, c);
  return c - a * b;
}
/// The constant `a` in lanes where the mask is set, `b` in the others.
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> select(const Mask<Arch, N>& m, double a,
                                                         double b) noexcept {
  return select(m, Pack<Arch, N>(a), Pack<Arch, N>(b));
}

// Elementary functions of math.hpp on packs: every lane has the bits of the scalar call.
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> sin(const Pack<Arch, N>& x) noexcept {
  return elementary::sin(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> cos(const Pack<Arch, N>& x) noexcept {
  return elementary::cos(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> tan(const Pack<Arch, N>& x) noexcept {
  return elementary::sin(x) / elementary::cos(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> atan(const Pack<Arch, N>& x) noexcept {
  return elementary::atan(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> atan2(const Pack<Arch, N>& y,
                                                        const Pack<Arch, N>& x) noexcept {
  return elementary::atan2(y, x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> exp(const Pack<Arch, N>& x) noexcept {
  return elementary::exp(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> log(const Pack<Arch, N>& x) noexcept {
  return elementary::log(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> tanh(const Pack<Arch, N>& x) noexcept {
  return elementary::tanh(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> asin(const Pack<Arch, N>& x) noexcept {
  return elementary::asin(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> acos(const Pack<Arch, N>& x) noexcept {
  return elementary::acos(x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> pow(const Pack<Arch, N>& x, double exponent) noexcept {
  return elementary::pow(x, exponent);
}
/// exp(exponent · log(x)), for whole exponents, too: NaN for x < 0.
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> pow(const Pack<Arch, N>& x,
                                                      const Pack<Arch, N>& exponent) noexcept {
  return elementary::exp(exponent * elementary::log(x));
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> hypot(const Pack<Arch, N>& x,
                                                        const Pack<Arch, N>& y) noexcept {
  return sqrt(x * x + y * y);
}

// Functions of a pack and a constant.
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> hypot(const Pack<Arch, N>& x, double y) noexcept {
  return hypot(x, Pack<Arch, N>(y));
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> hypot(double x, const Pack<Arch, N>& y) noexcept {
  return hypot(Pack<Arch, N>(x), y);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> atan2(const Pack<Arch, N>& y, double x) noexcept {
  return elementary::atan2(y, Pack<Arch, N>(x));
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> atan2(double y, const Pack<Arch, N>& x) noexcept {
  return elementary::atan2(Pack<Arch, N>(y), x);
}
template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> pow(double x, const Pack<Arch, N>& exponent) noexcept {
  return elementary::exp(log(x) * exponent);
}

template <class Arch, std::size_t N>
[[nodiscard]] CHICANE_INLINE inline Pack<Arch, N> positive_part(const Pack<Arch, N>& x) noexcept {
  return max(x, Pack<Arch, N>(0.0));
}

}  // namespace chicane
