// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace chicane::test {

constexpr std::size_t kCaseLanes = 8;
constexpr std::size_t kCaseCount = 24;

/// Every operation of Pack<Arch, 8> on a, b, c: `result` has one row for each, masks as 0 and 1.
template <class Arch>
void run_pack_cases(const double* a, const double* b, const double* c, double (*result)[kCaseLanes]) noexcept;

}  // namespace chicane::test
