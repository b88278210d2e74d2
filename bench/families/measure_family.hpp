// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/solver/ocp_solver.hpp"
#include "chicane/solver/warm_start.hpp"
#include "families/family.hpp"
#include "families/family_row.hpp"
#include "families/kkt.hpp"
#include "problems/cpu_time.hpp"
#if defined(CHICANE_HAVE_IPOPT)
#include "problems/ipopt_problem.hpp"
#endif
#if defined(CHICANE_HAVE_PEERS)
#include "references/fatrop_solver.hpp"
#include "references/hpipm_solver.hpp"
#endif

namespace chicane::bench {

/// Whether a family has instances that leave no solution.
template <class P>
inline constexpr bool kHasImpossible = requires(Random& random) {
  P::make_impossible(random);
};

template <class P>
class FamilyMeasurement {
 public:
  static constexpr int kHorizon = P::kHorizon;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, kHorizon>;

  static FamilyInstance<P> instance(int seed, bool is_impossible = false) {
    Random random{static_cast<std::uint64_t>(seed) * 7919U + 17U};
    if constexpr (kHasImpossible<P>) {
      if (is_impossible) return P::make_impossible(random);
    }
    return P::make(random);
  }
  /// The guess that belongs to a start.
  static Trajectory guess(const FamilyInstance<P>& instance, NaiveStart start) {
    Trajectory t;
    t.horizon = kHorizon;
    for (int k = 0; k < kHorizon; ++k) t.u[static_cast<std::size_t>(k)] = instance.idle;
    solver::roll_out(instance.problem, instance.start, t);
    if (start == NaiveStart::kIdle) return t;
    for (int k = 0; k <= kHorizon; ++k) {
      const double share = static_cast<double>(k) / kHorizon;
      for (std::size_t i = 0; i < P::kNx; ++i)
        t.x[static_cast<std::size_t>(k)][i] =
            instance.start[i] + share * (instance.goal[i] - instance.start[i]);
    }
    return t;
  }

  /// Where the multipliers of what must hold are.
  template <class Solver>
  static const auto& hard_multipliers(const Solver& ocp) {
    static constexpr NoHardMultipliers kNone;
    if constexpr (solver::HardProblem<P>) {
      return ocp;
    } else {
      return kNone;
    }
  }

  static FamilyRow measure(const FamilyRequest& request, NaiveStart start, References& references) {
    using Solver = solver::OcpSolver<P, kHorizon>;
    const auto ocp =
        std::make_unique<Solver>(solver::SolverOptions{.tolerance = request.tolerance,
                                                       .max_iterations = request.max_iterations,
                                                       .start_from_states = start == NaiveStart::kLine});
    FamilyRow row{.family = P::kName, .start = start, .instances = request.instances};
    std::vector<double> times, iterations, ratios;
    for (int i = request.first; i < request.first + request.instances; ++i) {
      const FamilyInstance<P> one = instance(i, request.is_impossible);
      const auto t = std::make_unique<Trajectory>();
      solver::SolveReport report;
      double time = 1e30;
      for (int repeat = 0; repeat < 2; ++repeat) {
        *t = guess(one, start);
        const double begin = cpu_time();
        report = ocp->solve(one.problem, one.start, *t);
        time = std::min(time, cpu_time() - begin);
      }
      const OverArrays<P> arrays{one.problem};
      const KktResidual kkt = check_kkt(
          arrays, *t, [&](int k, int c) { return ocp->constraint_multiplier(k, c); }, hard_multipliers(*ocp));
      const bool is_optimal = report.status == solver::SolveStatus::kOptimal;
      const bool is_asked = !is_optimal || i - request.first < request.ipopt_instances;
      const ReferenceAnswer reference = reference_of(request, references, one, arrays, start, i, is_asked);
      times.push_back(time);
      iterations.push_back(report.iterations);
      row.optimal += is_optimal ? 1 : 0;
      const bool is_at_floor = report.status == solver::SolveStatus::kAtFloor;
      row.at_floor += is_at_floor ? 1 : 0;
      const bool is_infeasible = report.status == solver::SolveStatus::kInfeasible;
      row.infeasible += is_infeasible ? 1 : 0;
      row.reference_infeasible += reference.is_impossible ? 1 : 0;
      if (is_infeasible && reference.is_impossible) {
        ++row.both_infeasible;
        row.further += kkt.total > reference.cost * (1.0 + 1e-4) + 1e-6 ? 1 : 0;
      }
      row.usable += solver::usable(report.status) ? 1 : 0;
      row.reference += reference.is_solved ? 1 : 0;
      row.both += reference.is_solved && is_optimal ? 1 : 0;
      const double worst = std::max({kkt.stationarity, kkt.defect, kkt.outside, kkt.miss});
      const bool is_false = is_optimal && !(worst <= 1.5 * request.tolerance + kkt.rounding &&
                                            kkt.subgradient <= 2.0 * std::sqrt(request.tolerance));
      row.false_optimal += is_false ? 1 : 0;
      if (is_optimal) row.worst_residual = std::max(row.worst_residual, worst);
      if (is_at_floor) row.floor_residual = std::max(row.floor_residual, worst);
      if (is_optimal && reference.is_solved) {
        ratios.push_back(reference.time / time);
        const double margin = 1e-2 * std::fabs(reference.cost) + 1e-6;
        row.lower += kkt.cost < reference.cost - margin ? 1 : 0;
        row.higher += kkt.cost > reference.cost + margin ? 1 : 0;
      }
      if (request.with_peers) {
        auto& all = row.compared.emplace_back();
        if (is_optimal) all[0] = {time, time, kkt.cost};
        ask_peers(one, start, all);
        if (reference.is_solved)
          all[3] = {reference.time, reference.time - reference.time_in_functions, reference.cost};
      }
      if (request.each) {
        std::printf(
            "%s %s %d: %s iterations %d sweeps %d cost %.8g stat %.2e defect %.2e | check stat %.2e defect "
            "%.2e "
            "sub %.2e miss %.2e total %.6g | ipopt %s %.8g iterations %d%s\n",
            P::kName.data(), to_string(start).data(), i, to_string(report.status).data(), report.iterations,
            report.sweeps, kkt.cost, report.stationarity, report.defect, kkt.stationarity, kkt.defect,
            kkt.subgradient, kkt.miss, kkt.total,
            reference.is_solved ? "cost" : (reference.is_impossible ? "infeasible total" : "none"),
            reference.cost, reference.iterations, is_false ? " FALSE" : "");
      }
    }
    row.iterations = detail::at_share(iterations, 0.5);
    row.time = detail::at_share(times, 0.5);
    row.most_time = detail::at_share(times, 0.99);
    row.ratio = detail::at_share(ratios, 0.5);
    row.least_ratio = detail::at_share(ratios, 0.01);
    return row;
  }

 private:
  static void ask_peers([[maybe_unused]] const FamilyInstance<P>& one, [[maybe_unused]] NaiveStart start,
                        [[maybe_unused]] std::array<SolveTime, kSolvers.size()>& all) {
#if defined(CHICANE_HAVE_PEERS)
    static HpipmSolver<P, kHorizon> hpipm;
    static FatropSolver<P, kHorizon> fatrop;
    const auto ask = [&](auto& solver, SolveTime& answer) {
      for (int repeat = 0; repeat < 2; ++repeat) {
        const auto t = std::make_unique<Trajectory>(guess(one, start));
        const Outcome outcome = solver.solve(one.problem, one.start, *t);
        if (!outcome.is_solved || outcome.time > answer.total) continue;
        const KktResidual kkt = check_kkt(OverArrays<P>{one.problem}, *t, [](int, int) { return 0.0; });
        answer = {outcome.time, outcome.time - outcome.time_in_functions, kkt.cost};
      }
    };
    ask(hpipm, all[1]);
    ask(fatrop, all[2]);
#endif
  }
  static ReferenceAnswer reference_of([[maybe_unused]] const FamilyRequest& request, References& references,
                                      [[maybe_unused]] const FamilyInstance<P>& one,
                                      [[maybe_unused]] const OverArrays<P>& arrays, NaiveStart start,
                                      int seed, [[maybe_unused]] bool is_asked) {
    const std::string key = std::string(P::kName) + (request.is_impossible ? " impossible|" : "|") +
                            std::string(to_string(start)) + "|" + std::to_string(seed);
    if (const auto known = references.find(key); known != references.end()) return known->second;
#if defined(CHICANE_HAVE_IPOPT)
    if (!request.with_ipopt || !is_asked) return {};
    static IpoptSolver<OverArrays<P>> ipopt;
    const auto t = std::make_unique<Trajectory>(guess(one, start));
    const Outcome report = ipopt.solve(arrays, one.start, *t);
    if (report.is_impossible) {
      for (int k = 0; k < kHorizon; ++k) {
        const auto low = one.problem.input_lower(k), high = one.problem.input_upper(k);
        auto& u = t->u[static_cast<std::size_t>(k)];
        for (std::size_t m = 0; m < u.size(); ++m) u[m] = std::clamp(u[m], low[m], high[m]);
      }
      solver::roll_out(one.problem, one.start, *t);
    }
    const KktResidual kkt = check_kkt(arrays, *t, [](int, int) { return 0.0; });
    return references[key] = {
               report.is_solved, report.is_impossible, report.is_impossible ? kkt.total : kkt.cost,
               report.time,      report.iterations,    report.time_in_functions};
#else
    return {};
#endif
  }
};

}  // namespace chicane::bench
