// SPDX-License-Identifier: MIT
#pragma once

#include "problems/reference.hpp"

namespace chicane::bench {

/// Ipopt with derivatives by CppAD, as the project's template does it: variables x, y, ψ, v, cte, eψ, δ, a
/// one after another, a new tape for each solve, "Sparse true forward". It starts from what it is given
/// ("cppad") like all others.
void add_cppad(References& references);

}  // namespace chicane::bench
