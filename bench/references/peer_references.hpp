// SPDX-License-Identifier: MIT
#pragma once

#include "problems/reference.hpp"

namespace chicane::bench {

/// fatrop and HPIPM on the structured forms, whose states are one fewer.
void add_peers(References& references);

}  // namespace chicane::bench
