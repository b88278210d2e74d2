// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

/// Points that fill a box evenly. Each is a pure function of its arguments, with the same bits on every
/// machine, so that any run of a sweep can be computed without the others. Numbers are in [0, 1).
namespace chicane::sweep {

inline constexpr int kSobolDimensions = 21;

/// Coordinate `dimension` of point `index` of Sobol's sequence (direction numbers of Joe and Kuo, 2008),
/// moved by a digital shift that `seed` chooses; seed 0 moves nothing. Each 2^k points that begin at a
/// multiple of 2^k have one coordinate in each 2^k-th of the interval. Pre: dimension in [0,
/// kSobolDimensions).
[[nodiscard]] double sobol(std::uint32_t index, int dimension, std::uint64_t seed) noexcept;

/// Coordinate `dimension` of point `index` of a Latin hypercube of `count` points: each count-th of the
/// interval has one. Pre: index < count.
[[nodiscard]] double latin_hypercube(std::uint32_t index, std::uint32_t count, int dimension,
                                     std::uint64_t seed) noexcept;

}  // namespace chicane::sweep
