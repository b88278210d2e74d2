// SPDX-License-Identifier: MIT
// Times a problem that Python exported (ocp.export) with our solver, with Ipopt, and beside the same problem
// written by hand, in turns: the least CPU time of each. python/tests/problem_table.py --references compiles
// it for each problem, with
//
//   -DEXPORTED='"problem.hpp"'     its header, with a struct Problem
//   -DWRITTEN                      cart-pole: bench's CartPole as well
//
// Reads the state at the start, then parameters row by row. Writes one line of JSON.
#include <cstdio>
#include <memory>
#include <vector>

#include EXPORTED
#include "families/pendulums.hpp"
#include "problems/ipopt_problem.hpp"

namespace {

using namespace chicane;
constexpr int kHorizon = Problem::kHorizon;
using Plan = solver::Trajectory<Problem::kNx, Problem::kNu, kHorizon>;
using Start = std::array<double, Problem::kNx>;

template <class P>
struct Timed {
  solver::OcpSolver<P, kHorizon> solver;
  double least = 1e30;
  double cost = 0.0;
  int status = 0;

  void solve(const P& problem, const Start& x0, Plan plan) {
    const double begin = bench::cpu_time();
    const auto report = solver.solve(problem, x0, plan);
    least = std::min(least, bench::cpu_time() - begin);
    cost = report.cost;
    status = static_cast<int>(report.status);
    last = plan;
  }
  Plan last;
};

double read_number() {
  double value = 0.0;
  return std::scanf("%lf", &value) == 1 ? value : 0.0;
}

}  // namespace

int main() {
  constexpr int kRepeats = 9;
  Problem problem;
  Start x0;
  for (double& value : x0) value = read_number();
  for (std::size_t k = 0; k <= kHorizon; ++k) {
    for (std::size_t n = 0; n < static_cast<std::size_t>(Problem::kParameters); ++n)
      problem.p[n].values[k] = read_number();
  }
  const auto own = std::make_unique<Timed<Problem>>();
  const auto warm = std::make_unique<Timed<Problem>>();
  Plan guess{.horizon = kHorizon};
  solver::roll_out(problem, x0, guess);
  bench::IpoptSolver<Problem, kHorizon> ipopt;
  bench::Outcome reference;
  double ipopt_least = 1e30, ipopt_cost = 0.0;
#if defined(WRITTEN)
  const bench::CartPole by_hand;
  const auto written = std::make_unique<Timed<bench::CartPole>>();
#endif
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    own->solve(problem, x0, guess);
#if defined(WRITTEN)
    written->solve(by_hand, x0, guess);
#endif
    warm->solve(problem, x0, own->last);
    Plan plan = guess;
    reference = ipopt.solve(problem, x0, plan);
    ipopt_least = std::min(ipopt_least, reference.time);
    ipopt_cost = bench::check_kkt(problem, plan).cost;
  }
  std::printf("{\"own_s\": %.9g, \"own_cost\": %.12g, \"status\": %d, \"warm_s\": %.9g, ", own->least,
              own->cost, own->status, warm->least);
#if defined(WRITTEN)
  std::printf("\"written_s\": %.9g, \"written_cost\": %.12g, ", written->least, written->cost);
#endif
  std::printf("\"ipopt_s\": %.9g, \"ipopt_cost\": %.12g, \"ipopt_turns\": %d, \"ipopt_solved\": %s}\n",
              ipopt_least, ipopt_cost, reference.iterations, reference.is_solved ? "true" : "false");
  return 0;
}
