// SPDX-License-Identifier: MIT
// Compiled once for each family: FAMILY is its type, FAMILY_HEADER where it is, MADE_BY what makes
// its entry.
#include FAMILY_HEADER
#include "families/measure_family.hpp"

namespace chicane::bench {

Family MADE_BY();
Family MADE_BY() { return family_of<FAMILY>(); }

}  // namespace chicane::bench
