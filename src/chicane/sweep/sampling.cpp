// SPDX-License-Identifier: MIT
#include "chicane/sweep/sampling.hpp"

#include <array>
#include <bit>

#include "chicane/base/assert.hpp"
#include "chicane/base/random.hpp"

namespace chicane::sweep {
namespace {

/// Joe and Kuo, new-joe-kuo-6: degree and coefficients of a primitive polynomial, first direction numbers.
struct Direction {
  unsigned degree;
  unsigned coefficients;
  std::array<unsigned, 7> first;
};
constexpr std::array<Direction, kSobolDimensions - 1> kDirections{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};
constexpr unsigned kBits = 32;

using SobolNumbers = std::array<std::uint32_t, kBits>;

constexpr SobolNumbers directions_of(int dimension) {
  SobolNumbers v{};
  if (dimension == 0) {
    for (unsigned i = 0; i < kBits; ++i) v[i] = 1U << (kBits - 1 - i);
    return v;
  }
  const Direction& d = kDirections[static_cast<std::size_t>(dimension - 1)];
  for (unsigned i = 0; i < kBits; ++i) {
    if (i < d.degree) {
      v[i] = d.first[i] << (kBits - 1 - i);
      continue;
    }
    v[i] = v[i - d.degree] ^ (v[i - d.degree] >> d.degree);
    for (unsigned k = 1; k < d.degree; ++k) v[i] ^= ((d.coefficients >> (d.degree - 1 - k)) & 1U) * v[i - k];
  }
  return v;
}

constexpr auto kSobolNumbers = [] {
  std::array<SobolNumbers, kSobolDimensions> columns{};
  for (int d = 0; d < kSobolDimensions; ++d) columns[static_cast<std::size_t>(d)] = directions_of(d);
  return columns;
}();

/// A number that depends on all of its arguments in no simple way.
std::uint64_t mixed(std::uint64_t seed, std::uint64_t a, std::uint64_t b) noexcept {
  Random random(seed * 0x9e3779b97f4a7c15ULL ^ (a * 0xc2b2ae3d27d4eb4fULL) ^ (b * 0x165667b19e3779f9ULL));
  static_cast<void>(random.bits());
  return random.bits();
}

/// A permutation of [0, count): a Feistel network over the next power of four, walked until it is inside.
std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint64_t key) noexcept {
  const unsigned half = (static_cast<unsigned>(std::bit_width(count - 1)) + 1) / 2;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  std::uint64_t at = index;
  do {
    std::uint64_t left = at >> half;
    std::uint64_t right = at & mask;
    for (std::uint64_t round = 0; round < 6; ++round) {
      const std::uint64_t next = left ^ (mixed(key, right, round) & mask);
      left = right;
      right = next;
    }
    at = left << half | right;
  } while (at >= count);
  return static_cast<std::uint32_t>(at);
}

}  // namespace

double sobol(std::uint32_t index, int dimension, std::uint64_t seed) noexcept {
  CHICANE_ASSERT(dimension >= 0 && dimension < kSobolDimensions);
  const SobolNumbers& v = kSobolNumbers[static_cast<std::size_t>(dimension)];
  const std::uint32_t gray = index ^ (index >> 1U);
  std::uint32_t x = 0;
  for (unsigned i = 0; i < kBits; ++i)
    if ((gray >> i & 1U) != 0) x ^= v[i];
  if (seed != 0) x ^= static_cast<std::uint32_t>(mixed(seed, static_cast<std::uint64_t>(dimension), 0));
  return static_cast<double>(x) * 0x1.0p-32;
}

double latin_hypercube(std::uint32_t index, std::uint32_t count, int dimension, std::uint64_t seed) noexcept {
  CHICANE_ASSERT(index < count);
  const auto d = static_cast<std::uint64_t>(dimension);
  const std::uint32_t cell = count == 1 ? 0 : permuted(index, count, mixed(seed, d, 1));
  Random inside(mixed(seed, d, 2) ^ index);
  return (static_cast<double>(cell) + inside.uniform()) / static_cast<double>(count);
}

}  // namespace chicane::sweep
