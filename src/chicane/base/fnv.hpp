// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

namespace chicane {

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
