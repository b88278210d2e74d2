// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace chicane {

/// A set of the variables of one stage, one bit each: states first, then inputs.
using Variables = std::uint32_t;
inline constexpr int kMaxVariables = 24;

[[nodiscard]] constexpr Variables variable(int index) noexcept { return Variables{1} << index; }
/// Variables 0 … count − 1.
[[nodiscard]] constexpr Variables first_variables(int count) noexcept { return variable(count) - 1; }
[[nodiscard]] constexpr bool contains(Variables set, int index) noexcept { return (set >> index & 1U) != 0; }
[[nodiscard]] constexpr int size_of(Variables set) noexcept { return std::popcount(set); }
/// How many members of the set come before `index`: where its entry is stored.
[[nodiscard]] constexpr std::size_t rank_of(Variables set, int index) noexcept {
  return static_cast<std::size_t>(std::popcount(set & (variable(index) - 1)));
}
/// The member with `rank` others before it.
[[nodiscard]] constexpr int member_of(Variables set, int rank) noexcept {
  for (; rank > 0; --rank) set &= set - 1;
  return std::countr_zero(set);
}

/// A set of unordered pairs of variables: the pattern of a symmetric matrix. Usable as a template argument.
struct Pairs {
  std::array<std::uint64_t, 5> words{};  ///< public, so that the type is structural: use the functions

  static constexpr int index_of(int i, int j) noexcept {
    return i <= j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j;
  }
  [[nodiscard]] constexpr bool contains(int i, int j) const noexcept {
    const auto at = static_cast<unsigned>(index_of(i, j));
    return (words[at / 64] >> (at % 64) & 1U) != 0;
  }
  constexpr void insert(int i, int j) noexcept {
    const auto at = static_cast<unsigned>(index_of(i, j));
    words[at / 64] |= std::uint64_t{1} << (at % 64);
  }
  [[nodiscard]] constexpr int size() const noexcept {
    int sum = 0;
    for (const auto word : words) sum += std::popcount(word);
    return sum;
  }
  [[nodiscard]] constexpr std::size_t rank(int i, int j) const noexcept {
    const auto at = static_cast<unsigned>(index_of(i, j));
    int sum = std::popcount(words[at / 64] & ((std::uint64_t{1} << (at % 64)) - 1));
    for (unsigned w = 0; w < at / 64; ++w) sum += std::popcount(words[w]);
    return static_cast<std::size_t>(sum);
  }
  /// All pairs with one variable of each set.
  static constexpr Pairs of(Variables a, Variables b) noexcept {
    Pairs result;
    for (Variables rest = a; rest != 0; rest &= rest - 1) {
      for (Variables other = b; other != 0; other &= other - 1)
        result.insert(std::countr_zero(rest), std::countr_zero(other));
    }
    return result;
  }
  constexpr Pairs& operator|=(const Pairs& o) noexcept {
    for (std::size_t w = 0; w < words.size(); ++w) words[w] |= o.words[w];
    return *this;
  }
  friend constexpr Pairs operator|(Pairs a, const Pairs& b) noexcept { return a |= b; }
  friend constexpr bool operator==(const Pairs&, const Pairs&) = default;
  /// Every pair of this set is in the other one.
  [[nodiscard]] constexpr bool is_within(const Pairs& o) const noexcept { return (*this | o) == o; }
};

struct Pair {
  int i = 0;
  int j = 0;
};

/// The members of a set of pairs in the order of their storage.
template <Pairs Set>
[[nodiscard]] constexpr auto members() noexcept {
  std::array<Pair, static_cast<std::size_t>(Set.size())> result{};
  std::size_t at = 0;
  for (int j = 0; j < kMaxVariables; ++j) {
    for (int i = 0; i <= j; ++i) {
      if (Set.contains(i, j)) result[at++] = {i, j};
    }
  }
  return result;
}

}  // namespace chicane
