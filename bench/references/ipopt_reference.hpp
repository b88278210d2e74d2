// SPDX-License-Identifier: MIT
#pragma once

#include "problems/reference.hpp"

namespace chicane::bench {

/// Ipopt with exact derivatives, from a plain start and ("ipopt_hot") from its own multipliers of the cycle
/// before, shifted. The described problem is written by hand for it (described_nlp.hpp).
void add_ipopt(References& references);

}  // namespace chicane::bench
