// SPDX-License-Identifier: MIT
// Operations on one register of doubles for each instruction set (SSE2, AVX2, AVX-512, NEON), for pack.hpp.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "chicane/base/compiler.hpp"
#include "chicane/base/instruction_set.hpp"

// Longer than other headers because every processor has its own names for the same dozen operations.
#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__x86_64__)
#include <emmintrin.h>  // SSE2 alone: a third of the compiler's memory for immintrin.h
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace chicane {

/// Calls f(std::integral_constant<std::size_t, 0>) … f(…<N − 1>): a loop that is always unrolled, and whose
/// index is a constant.
template <std::size_t N, class F>
CHICANE_INLINE inline constexpr void unroll(F&& f) noexcept {
  [&]<std::size_t... I>(std::index_sequence<I...>) CHICANE_INLINE {
    (f(std::integral_constant<std::size_t, I>{}), ...);
  }
  (std::make_index_sequence<N>{});
}

/// Registers and their operations. For base/pack.hpp alone.
namespace pack_detail {

/// One register of W doubles: its types, and moves from and to memory.
template <std::size_t W>
struct Lanes {
  using Real [[gnu::vector_size(W * 8)]] = double;
  using Integer [[gnu::vector_size(W * 8)]] = long long;
  using Unsigned [[gnu::vector_size(W * 8)]] = unsigned long long;

  // Loads and stores of one register, aligned to its size or not at all. Pointers are cast in place of
  // memcpy, which would take the variable's address and so keep the variable in memory.
  CHICANE_INLINE static Real load(const double* from) noexcept {
    return *static_cast<const Aligned*>(static_cast<const void*>(from));
  }
  CHICANE_INLINE static Real load_unaligned(const double* from) noexcept {
    return *static_cast<const Unaligned*>(static_cast<const void*>(from));
  }
  CHICANE_INLINE static void store(double* to, Real value) noexcept {
    *static_cast<Aligned*>(static_cast<void*>(to)) = value;
  }
  CHICANE_INLINE static void store_unaligned(double* to, Real value) noexcept {
    *static_cast<Unaligned*>(static_cast<void*>(to)) = value;
  }

 private:
  using Aligned [[gnu::vector_size(W * 8), gnu::may_alias]] = double;
  using Unaligned [[gnu::vector_size(W * 8), gnu::may_alias, gnu::aligned(8)]] = double;
};

/// Operations by the compiler's vector extensions alone. The specialisations of Ops below replace those for
/// which an instruction set has an instruction that compilers do not find by themselves.
template <std::size_t W>
struct Portable {
  using Real = typename Lanes<W>::Real;
  using Integer = typename Lanes<W>::Integer;
  using Mask = Integer;
  CHICANE_INLINE static Real add(Real a, Real b) noexcept { return a + b; }
  CHICANE_INLINE static Real subtract(Real a, Real b) noexcept { return a - b; }
  CHICANE_INLINE static Real multiply(Real a, Real b) noexcept { return a * b; }
  CHICANE_INLINE static Real divide(Real a, Real b) noexcept { return a / b; }
  CHICANE_INLINE static Real negate(Real a) noexcept { return -a; }
  CHICANE_INLINE static Integer integer_and(Integer a, Integer b) noexcept { return a & b; }
  CHICANE_INLINE static Integer integer_or(Integer a, Integer b) noexcept { return a | b; }
  CHICANE_INLINE static Integer integer_xor(Integer a, Integer b) noexcept { return a ^ b; }
  CHICANE_INLINE static Integer integer_add(Integer a, Integer b) noexcept { return a + b; }
  CHICANE_INLINE static Integer integer_subtract(Integer a, Integer b) noexcept { return a - b; }
  CHICANE_INLINE static Integer shift_left(Integer a, int count) noexcept { return a << count; }
  CHICANE_INLINE static Integer shift_right(Integer a, int count) noexcept {
    using Unsigned = typename Lanes<W>::Unsigned;
    return std::bit_cast<Integer>(std::bit_cast<Unsigned>(a) >> static_cast<unsigned long long>(count));
  }
  CHICANE_INLINE static Integer to_bits(Real a) noexcept { return std::bit_cast<Integer>(a); }
  CHICANE_INLINE static Real to_real(Integer a) noexcept { return std::bit_cast<Real>(a); }
  CHICANE_INLINE static Mask less(Real a, Real b) noexcept { return a < b; }
  CHICANE_INLINE static Mask less_equal(Real a, Real b) noexcept { return a <= b; }
  CHICANE_INLINE static Mask equal(Real a, Real b) noexcept { return a == b; }
  CHICANE_INLINE static Mask from_bits(Integer a) noexcept { return a != Integer{}; }
  CHICANE_INLINE static Real select(Mask m, Real a, Real b) noexcept { return m ? a : b; }
  CHICANE_INLINE static Mask inverse(Mask m) noexcept { return ~m; }
  CHICANE_INLINE static Mask both(Mask a, Mask b) noexcept { return a & b; }
  CHICANE_INLINE static Mask either(Mask a, Mask b) noexcept { return a | b; }
  CHICANE_INLINE static unsigned bits(Mask m) noexcept {
    unsigned result = 0;
    for (std::size_t i = 0; i < W; ++i) result |= (m[i] != 0 ? 1U : 0U) << i;
    return result;
  }
  CHICANE_INLINE static Real min(Real a, Real b) noexcept { return a < b ? a : b; }
  CHICANE_INLINE static Real max(Real a, Real b) noexcept { return a > b ? a : b; }
  CHICANE_INLINE static Real sqrt(Real a) noexcept {
    for (std::size_t i = 0; i < W; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  }
  CHICANE_INLINE static Real round(Real a) noexcept {
    constexpr double kBig = 4503599627370496.0;  // 2^52: larger doubles have no fraction
    const Integer sign = std::bit_cast<Integer>(a) & (Integer{} + INT64_MIN);
    const Real magnitude = std::bit_cast<Real>(std::bit_cast<Integer>(a) ^ sign);
    const Real rounded = (magnitude + kBig) - kBig;
    return magnitude < kBig ? std::bit_cast<Real>(std::bit_cast<Integer>(rounded) | sign) : a;
  }
  CHICANE_INLINE static Real fused_multiply_add(Real a, Real b, Real c) noexcept { return a * b + c; }
  CHICANE_INLINE static Real fused_negative_multiply_add(Real a, Real b, Real c) noexcept {
    return c - a * b;
  }
};

/// Operations of the instruction set `Arch` on a register of W doubles.
template <class Arch, std::size_t W>
struct Ops : Portable<W> {
  static_assert(std::is_same_v<Arch, arch::Baseline>, "this file is not compiled for that instruction set");
};

#if defined(__x86_64__)
template <>
struct Ops<arch::Baseline, 2> : Portable<2> {
  CHICANE_INLINE static Real min(Real a, Real b) noexcept { return _mm_min_pd(a, b); }
  CHICANE_INLINE static Real max(Real a, Real b) noexcept { return _mm_max_pd(a, b); }
  CHICANE_INLINE static Real sqrt(Real a) noexcept { return _mm_sqrt_pd(a); }
  CHICANE_INLINE static unsigned bits(Mask m) noexcept {
    return static_cast<unsigned>(_mm_movemask_pd(std::bit_cast<Real>(m)));
  }
};
#endif

#if defined(__AVX2__) && defined(__FMA__)
/// Rounding to the nearest integer, ties to even, without exceptions.
constexpr int kToNearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
template <>
struct Ops<arch::Avx2, 2> : Ops<arch::Baseline, 2> {
  CHICANE_INLINE static Real round(Real a) noexcept { return _mm_round_pd(a, kToNearest); }
  CHICANE_INLINE static Real fused_multiply_add(Real a, Real b, Real c) noexcept {
    return _mm_fmadd_pd(a, b, c);
  }
  CHICANE_INLINE static Real fused_negative_multiply_add(Real a, Real b, Real c) noexcept {
    return _mm_fnmadd_pd(a, b, c);
  }
};
template <>
struct Ops<arch::Avx2, 4> : Portable<4> {
  CHICANE_INLINE static Real select(Mask m, Real a, Real b) noexcept {
    return _mm256_blendv_pd(b, a, std::bit_cast<Real>(m));
  }
  CHICANE_INLINE static unsigned bits(Mask m) noexcept {
    return static_cast<unsigned>(_mm256_movemask_pd(std::bit_cast<Real>(m)));
  }
  CHICANE_INLINE static Real min(Real a, Real b) noexcept { return _mm256_min_pd(a, b); }
  CHICANE_INLINE static Real max(Real a, Real b) noexcept { return _mm256_max_pd(a, b); }
  CHICANE_INLINE static Real sqrt(Real a) noexcept { return _mm256_sqrt_pd(a); }
  CHICANE_INLINE static Real round(Real a) noexcept { return _mm256_round_pd(a, kToNearest); }
  CHICANE_INLINE static Real fused_multiply_add(Real a, Real b, Real c) noexcept {
    return _mm256_fmadd_pd(a, b, c);
  }
  CHICANE_INLINE static Real fused_negative_multiply_add(Real a, Real b, Real c) noexcept {
    return _mm256_fnmadd_pd(a, b, c);
  }
};
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
template <>
struct Ops<arch::Avx512, 2> : Ops<arch::Avx2, 2> {};
template <>
struct Ops<arch::Avx512, 4> : Ops<arch::Avx2, 4> {};
template <>
struct Ops<arch::Avx512, 8> : Portable<8> {
  using Mask = __mmask8;
  CHICANE_INLINE static Mask less(Real a, Real b) noexcept { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  CHICANE_INLINE static Mask less_equal(Real a, Real b) noexcept {
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
  }
  CHICANE_INLINE static Mask equal(Real a, Real b) noexcept { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
  CHICANE_INLINE static Mask from_bits(Integer a) noexcept {
    const auto bits = std::bit_cast<__m512i>(a);
    return _mm512_test_epi64_mask(bits, bits);
  }
  CHICANE_INLINE static Real select(Mask m, Real a, Real b) noexcept { return _mm512_mask_blend_pd(m, b, a); }
  CHICANE_INLINE static Mask inverse(Mask m) noexcept { return static_cast<Mask>(~m); }
  CHICANE_INLINE static Mask both(Mask a, Mask b) noexcept { return static_cast<Mask>(a & b); }
  CHICANE_INLINE static Mask either(Mask a, Mask b) noexcept { return static_cast<Mask>(a | b); }
  CHICANE_INLINE static unsigned bits(Mask m) noexcept { return m; }
  CHICANE_INLINE static Real min(Real a, Real b) noexcept { return _mm512_min_pd(a, b); }
  CHICANE_INLINE static Real max(Real a, Real b) noexcept { return _mm512_max_pd(a, b); }
  CHICANE_INLINE static Real sqrt(Real a) noexcept { return _mm512_sqrt_pd(a); }
  CHICANE_INLINE static Real round(Real a) noexcept { return _mm512_roundscale_pd(a, kToNearest); }
  CHICANE_INLINE static Real fused_multiply_add(Real a, Real b, Real c) noexcept {
    return _mm512_fmadd_pd(a, b, c);
  }
  CHICANE_INLINE static Real fused_negative_multiply_add(Real a, Real b, Real c) noexcept {
    return _mm512_fnmadd_pd(a, b, c);
  }
};
#endif

#if defined(__aarch64__)
template <>
struct Ops<arch::Neon, 2> : Portable<2> {
  CHICANE_INLINE static Real sqrt(Real a) noexcept { return cast(vsqrtq_f64(cast(a))); }
  CHICANE_INLINE static Real round(Real a) noexcept { return cast(vrndnq_f64(cast(a))); }
  CHICANE_INLINE static Real fused_multiply_add(Real a, Real b, Real c) noexcept {
    return cast(vfmaq_f64(cast(c), cast(a), cast(b)));
  }
  CHICANE_INLINE static Real fused_negative_multiply_add(Real a, Real b, Real c) noexcept {
    return cast(vfmsq_f64(cast(c), cast(a), cast(b)));
  }

 private:
  CHICANE_INLINE static float64x2_t cast(Real a) noexcept { return std::bit_cast<float64x2_t>(a); }
  template <class T = float64x2_t>
  requires(!std::is_same_v<T, Real>) CHICANE_INLINE static Real cast(T a) noexcept {
    return std::bit_cast<Real>(a);
  }
};
#endif

/// Transposes a block of W × W numbers, one row in each of W registers.
template <std::size_t W, class Real>
CHICANE_INLINE inline void transpose_block(Real* r) noexcept {
  if constexpr (W == 2) {
    const Real a = __builtin_shufflevector(r[0], r[1], 0, 2);
    r[1] = __builtin_shufflevector(r[0], r[1], 1, 3);
    r[0] = a;
  } else if constexpr (W == 4) {
    const Real a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
    const Real b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    const Real c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
    const Real d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
  } else {
#if defined(__AVX512F__)
    static_assert(W == 8);
    __m512d t[8];
    for (std::size_t i = 0; i < 4; ++i) {
      t[2 * i] = _mm512_unpacklo_pd(r[2 * i], r[2 * i + 1]);
      t[2 * i + 1] = _mm512_unpackhi_pd(r[2 * i], r[2 * i + 1]);
    }
    __m512d q[8];
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        q[4 * i + j] = _mm512_shuffle_f64x2(t[4 * i + j], t[4 * i + 2 + j], 0x88);
        q[4 * i + 2 + j] = _mm512_shuffle_f64x2(t[4 * i + j], t[4 * i + 2 + j], 0xdd);
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      r[i] = _mm512_shuffle_f64x2(q[i], q[4 + i], 0x88);
      r[4 + i] = _mm512_shuffle_f64x2(q[i], q[4 + i], 0xdd);
    }
#endif
  }
}

/// result[p] = Op(operands[p]…) for every register p, always unrolled.
template <auto Op, class Result, class... Operands>
CHICANE_INLINE inline Result by_parts(const Operands&... operands) noexcept {
  Result r;
  unroll<Result::kParts>([&](auto p) CHICANE_INLINE { r.part[p] = Op(operands.part[p]...); });
  return r;
}

}  // namespace pack_detail

}  // namespace chicane
