// SPDX-License-Identifier: MIT
// Random numbers and hashes with the same bits on every machine.
#pragma once

#include <bit>
#include <cstdint>

#include "chicane/base/math.hpp"

namespace chicane {

/// Seeded random numbers with the same bits on every machine (the standard distributions are not portable).
/// SplitMix64 with its constants (Steele, Lea, Flood 2014); normal numbers by Box–Muller with math.hpp's
/// cosine and logarithm. No allocation.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_{seed} {}

  /// 64 random bits, the next number of the stream.
  [[nodiscard]] std::uint64_t bits() noexcept {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  /// Uniform in [0, 1).
  [[nodiscard]] double uniform() noexcept { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  /// Normal with mean 0 and standard deviation 1; always uses two numbers of the stream.
  [[nodiscard]] double normal() noexcept {
    const double u = 1.0 - uniform();
    const double v = uniform();
    return sqrt(-2.0 * log(u)) * cos(kTwoPi * v);
  }

 private:
  std::uint64_t state_;
};

/// Hash of numbers by FNV-1a, for determinism checks: two runs with different bits have, but for chance,
/// different hashes. Not for security.
class Fnv {
 public:
  /// Adds the eight bytes of a number, the lowest first.
  void add(std::uint64_t value) noexcept {
    constexpr std::uint64_t kPrime = 0x100000001b3ULL;  // prime of FNV with 64 bits
    for (int shift = 0; shift < 64; shift += 8) hash_ = (hash_ ^ ((value >> shift) & 0xffU)) * kPrime;
  }
  /// Adds the bits of a number; 0.0 and -0.0 count as equal.
  void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;  ///< offset basis of FNV with 64 bits
};

}  // namespace chicane
