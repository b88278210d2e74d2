// SPDX-License-Identifier: MIT
#include "fuzz/list.hpp"

#include <array>

namespace chicane::bench {

// One for each type of problems, compiled alone (one_kind.cpp).
FuzzKind fuzz_small();
FuzzKind fuzz_middle();
FuzzKind fuzz_wide();
FuzzKind fuzz_lanes();
FuzzKind fuzz_branches();
FuzzKind fuzz_one();
FuzzKind fuzz_hard_end();
FuzzKind fuzz_hard_stages();
FuzzKind fuzz_hard_arrays();

std::span<const FuzzKind> all_fuzz_kinds() {
  static const std::array kinds{fuzz_one(),      fuzz_small(),       fuzz_middle(),
                                fuzz_wide(),     fuzz_lanes(),       fuzz_branches(),
                                fuzz_hard_end(), fuzz_hard_stages(), fuzz_hard_arrays()};
  return kinds;
}

}  // namespace chicane::bench
