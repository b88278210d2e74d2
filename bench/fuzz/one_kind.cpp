// SPDX-License-Identifier: MIT
// Compiled once for each type of random problems: KIND is the type, KIND_NAME its name, MADE_BY what
// makes its entry.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "fuzz/classify.hpp"
#include "fuzz/list.hpp"
#include "fuzz/random_problem.hpp"
#include "problems/cpu_time.hpp"

namespace chicane::bench {
namespace {

using P = KIND;
constexpr int kCapacity = 40;
using Ocp = solver::OcpSolver<P, kCapacity>;
using Case = FuzzCase<P, kCapacity>;

FuzzTally run(long count, long first) {
  FuzzTally tally;
  const auto one = std::make_unique<Case>();
  for (long seed = first; seed < first + count; ++seed) {
    Random random{static_cast<std::uint64_t>(seed) * 2654435761U + 11U};
    make_case(random, *one);
    const auto ocp = std::make_unique<Ocp>(one->options);
    const double begin = cpu_time();
    one->report = ocp->solve(one->problem, one->start, one->answer);
    const double time = cpu_time() - begin;
    tally.slowest = std::max(tally.slowest, time);
    ++tally.by_status[static_cast<std::size_t>(static_cast<int>(one->report.status) + 3)];
    const Judge<P, kCapacity, Ocp> judge{*one, *ocp};
    const Wrong wrong = time > 5.0 ? Wrong::kSlow : judge.verdict();
    if (wrong == Wrong::kNothing) continue;
    ++tally.wrong;
    const KktResidual kkt = judge.check(one->answer);
    std::printf(
        "%s %ld: %s (%s, %d iterations, tolerance %.0e, says %.2e %.2e %.2e; check: slope %.2e defect %.2e "
        "multipliers "
        "%.2e "
        "outside %.2e miss %.2e rounding %.2e cost %.6g)\n",
        KIND_NAME, seed, kWrongNames[static_cast<int>(wrong)], to_string(one->report.status).data(),
        one->report.iterations, one->options.tolerance, one->report.stationarity, one->report.defect,
        one->report.complementarity, kkt.stationarity, kkt.defect, kkt.subgradient, kkt.outside, kkt.miss,
        kkt.rounding, kkt.cost);
  }
  return tally;
}

}  // namespace

FuzzKind MADE_BY();
FuzzKind MADE_BY() { return {KIND_NAME, &run}; }

}  // namespace chicane::bench
