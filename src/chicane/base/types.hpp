// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace chicane {

/// Fixed-size column vector, unaligned so that structs holding it have the same layout with every -march.
template <int N, class T = double>
using Vec = Eigen::Matrix<T, N, 1, Eigen::DontAlign>;

/// Fixed-size matrix with R rows and C columns.
template <int R, int C, class T = double>
using Mat = Eigen::Matrix<T, R, C, (R == 1 && C != 1 ? Eigen::RowMajor : Eigen::ColMajor) | Eigen::DontAlign>;

/// A point or direction in a plane [m].
using Vec2 = Vec<2>;

}  // namespace chicane
