// SPDX-License-Identifier: MIT
// Dense and large patterns, without forced inlining: with it they would take the compiler two minutes.
#include "solver/lq_cases_solve.hpp"

namespace chicane::test {

template void solve_lq<arch::Native, solver::FullPattern<5, 3>>(const LqData&, LqAnswer&) noexcept;
template void solve_lq<arch::Native, solver::FullPattern<2, 4>>(const LqData&, LqAnswer&) noexcept;
template void solve_lq<arch::Native, solver::FullPattern<10, 2>>(const LqData&, LqAnswer&) noexcept;
template void solve_lq<arch::Native, Compact<solver::FullPattern<23, 2>>>(const LqData&, LqAnswer&) noexcept;
#ifdef CHICANE_SLOW_TESTS
template void solve_lq<arch::Native, solver::FullPattern<8, 2>>(const LqData&, LqAnswer&) noexcept;
template void solve_lq<arch::Native, Compact<solver::FullPattern<8, 2>>>(const LqData&, LqAnswer&) noexcept;
#endif

}  // namespace chicane::test
