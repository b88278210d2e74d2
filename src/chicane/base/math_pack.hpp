// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/detail/elementary.hpp"
#include "chicane/base/inlining.hpp"
#include "chicane/base/pack.hpp"

namespace chicane {

/// The elementary functions of math.hpp on packs: every lane has the bits of the scalar call.
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
/// exp(exponent · log(x)), whatever the exponent: NaN for x < 0.
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

// With a constant.
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
