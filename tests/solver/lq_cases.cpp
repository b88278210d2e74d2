// SPDX-License-Identifier: MIT
// Patterns as users have them, compiled as users compile them.
#include "solver/lq_cases_solve.hpp"

namespace chicane::test {

template void solve_lq<arch::Native, SparsePattern>(const LqData&, LqAnswer&) noexcept;
template void solve_lq<arch::Native, MemorylessPattern>(const LqData&, LqAnswer&) noexcept;
template void solve_lq<arch::Native, solver::FullPattern<2, 1>>(const LqData&, LqAnswer&) noexcept;
template void solve_lq<arch::Native, Compact<SparsePattern>>(const LqData&, LqAnswer&) noexcept;

}  // namespace chicane::test
