// SPDX-License-Identifier: MIT
#pragma once

namespace chicane {

/// Tests of many runs drive a sample of them; all with `./test.sh --all`.
#ifdef CHICANE_SLOW_TESTS
inline constexpr bool kDrivesAll = true;
#else
inline constexpr bool kDrivesAll = false;
#endif

}  // namespace chicane
