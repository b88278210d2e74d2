// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

#include "chicane/base/math.hpp"

namespace chicane {

/// Seeded random numbers with the same bits on every machine (the standard distributions are not portable).
/// SplitMix64 (Steele, Lea, Flood 2014); normal numbers by Box–Muller on our own sine and logarithm. No
/// allocation.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_{seed} {}

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

/// FNV-1a over the bytes of numbers, for determinism checks: equal hashes mean equal bits. Not for security.
class Fnv {
 public:
  void add(std::uint64_t value) noexcept {
    for (int shift = 0; shift < 64; shift += 8) {
      hash_ = (hash_ ^ ((value >> shift) & 0xffU)) * 0x100000001b3ULL;
    }
  }
  void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace chicane
