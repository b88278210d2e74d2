// SPDX-License-Identifier: MIT
// Compiled once for each family: FAMILY is its type, FAMILY_HEADER where it is, FAMILY_FUNCTION what makes
// its entry.
#include FAMILY_HEADER
#include "families/list.hpp"
#include "families/measure_family.hpp"
#include "families/measure_loop.hpp"

namespace chicane::bench {

Family FAMILY_FUNCTION();
Family FAMILY_FUNCTION() {
  return {FAMILY::kName, &FamilyMeasurement<FAMILY>::measure, loop_of<FAMILY>(), kHasImpossible<FAMILY>};
}

}  // namespace chicane::bench
