// SPDX-License-Identifier: MIT
// Compiled once for each family: FAMILY is its type, FAMILY_HEADER where it is, MADE_BY what makes
// its entry.
#include FAMILY_HEADER
#include "families/list.hpp"
#include "families/measure_family.hpp"
#include "families/measure_loop.hpp"

namespace chicane::bench {

Family MADE_BY();
Family MADE_BY() {
  return {FAMILY::kName, &FamilyMeasurement<FAMILY>::measure, loop_of<FAMILY>(), kHasImpossible<FAMILY>};
}

}  // namespace chicane::bench
