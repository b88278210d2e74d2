// SPDX-License-Identifier: MIT
// The solver on families of problems that are no car, beside Ipopt: how many are solved, at what cost, in
// what time.
//
// Prints the tables of docs/measured/solver.md; `--help` lists its options. Ipopt takes minutes, so
// a file keeps its results; without Ipopt (Debian: coinor-libipopt-dev) the file alone is compared with.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "families/list.hpp"

namespace {

using namespace chicane::bench;
using chicane::solver::SolveStatus;

constexpr std::array kStarts{NaiveStart::kIdle, NaiveStart::kLine};

References read(const std::string& file) {
  References references;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    const auto tab = line.rfind('\t');
    int is_solved = 0;
    Outcome answer;
    if (tab == std::string::npos || std::sscanf(line.c_str() + tab + 1, "%d %lf %lf %d", &is_solved,
                                                &answer.cost, &answer.time, &answer.iterations) != 4)
      continue;
    answer.is_solved = is_solved == 1;
    answer.is_impossible = is_solved == 2;
    references[line.substr(0, tab)] = answer;
  }
  return references;
}
void write(const References& references, const std::string& file) {
  if (file.empty()) return;
  std::ofstream out(file);
  for (const auto& [key, answer] : references) {
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, "%d %.17g %.6g %d",
                  answer.is_impossible ? 2 : (answer.is_solved ? 1 : 0), answer.cost, answer.time,
                  answer.iterations);
    out << key << '\t' << numbers << '\n';
  }
}

// ---- numbers of many solves

double at_share(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}
template <class Is>
int count(const FamilySolves& solves, const Is& is) {
  const auto holds = [&](const FamilySolve& s) { return std::invoke(is, s); };
  return static_cast<int>(std::count_if(solves.begin(), solves.end(), holds));
}
int count(const FamilySolves& solves, SolveStatus status) {
  return count(solves, [&](const FamilySolve& s) { return s.has(status); });
}
int solved(const FamilySolves& solves, Peer peer) {
  return count(solves, [&](const FamilySolve& s) { return s.by[peer].is_solved; });
}
int solved_by_both(const FamilySolves& solves, Peer peer) {
  return count(solves, [&](const FamilySolve& s) { return s.by[kOurs].is_solved && s.by[peer].is_solved; });
}
/// How often one peer's cost is more than 1 % (and 1e-6) above another's, where both solve.
int dearer(const FamilySolves& solves, Peer dear, Peer cheap, Peer margin_of) {
  return count(solves, [&](const FamilySolve& s) {
    const double margin = 1e-2 * std::fabs(s.by[margin_of].cost) + 1e-6;
    return s.by[dear].is_solved && s.by[cheap].is_solved && s.by[dear].cost > s.by[cheap].cost + margin;
  });
}
template <class Value>
std::vector<double> numbers(const FamilySolves& solves, const Value& value) {
  std::vector<double> all;
  for (const FamilySolve& s : solves) all.push_back(value(s));
  return all;
}
double median_iterations(const FamilySolves& solves) {
  return at_share(numbers(solves, [](const FamilySolve& s) { return s.report.iterations; }), 0.5);
}
/// Our time [ms].
double our_time(const FamilySolves& solves, double share) {
  return 1e3 * at_share(numbers(solves, [](const FamilySolve& s) { return s.by[kOurs].time; }), share);
}
/// The time of `peer` over ours, where both solve; without the problem's functions where they are free.
double ratio(const FamilySolves& solves, Peer peer, double share, bool are_functions_free = false) {
  std::vector<double> ratios;
  for (const FamilySolve& s : solves) {
    if (!s.by[kOurs].is_solved || !s.by[peer].is_solved) continue;
    const double free = are_functions_free ? s.by[peer].time_in_functions : 0.0;
    ratios.push_back((s.by[peer].time - free) / s.by[kOurs].time);
  }
  return at_share(ratios, share);
}
/// Largest residual of answers with a status.
double worst_residual(const FamilySolves& solves, SolveStatus status) {
  double worst = 0.0;
  for (const FamilySolve& s : solves) {
    if (s.has(status)) worst = std::max(worst, s.worst());
  }
  return worst;
}

// ---- tables

using Names = std::vector<std::string>;

/// Calls visit(family) for those whose name contains one of the names, or for all.
template <class Visit>
void each_family(const Names& names, const Visit& visit) {
  for (const Family& family : all_families()) {
    const auto is_in = [&](const std::string& name) {
      return family.name.find(name) != std::string_view::npos;
    };
    if (names.empty() || std::any_of(names.begin(), names.end(), is_in)) visit(family);
    std::fflush(stdout);
  }
}

/// A line for each instance.
void print_each(const Family& family, NaiveStart start, const FamilySolves& solves) {
  for (const FamilySolve& s : solves) {
    const Outcome& ipopt = s.by[kIpopt];
    std::printf(
        "%s %s %d: %s iterations %d sweeps %d cost %.8g stat %.2e defect %.2e | check stat %.2e defect %.2e "
        "sub %.2e miss %.2e total %.6g | ipopt %s %.8g iterations %d%s\n",
        family.name.data(), to_string(start).data(), s.seed, to_string(s.report.status).data(),
        s.report.iterations, s.report.sweeps, s.kkt.cost, s.report.stationarity, s.report.defect,
        s.kkt.stationarity, s.kkt.defect, s.kkt.subgradient, s.kkt.miss, s.kkt.total,
        ipopt.is_solved ? "cost" : (ipopt.is_impossible ? "infeasible total" : "none"), ipopt.cost,
        ipopt.iterations, s.is_false ? " FALSE" : "");
  }
}

/// Each family beside Ipopt; then, of problems without a solution, counts of infeasible and of usable
/// answers, and of points with larger misses than Ipopt's.
int print_families(FamilyRequest request, const Names& names, const std::string& file, bool each) {
  References references = read(file);
  int both = 0, reference = 0, wrong = 0;
  std::printf(
      "| family | from | solved | of Ipopt's | less / more | iterations | time [ms] | p99 | ratio | p1 |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  const auto solve = [&](const Family& family, NaiveStart start) {
    FamilySolves solves = family.solve(request, start, references);
    if (each) print_each(family, start, solves);
    write(references, file);
    return solves;
  };
  each_family(names, [&](const Family& family) {
    for (const NaiveStart start : kStarts) {
      const FamilySolves all = solve(family, start);
      std::printf("| %s | %s | %d of %d | %d of %d | %d / %d | %.0f | %.2f | %.2f | %.0f | %.0f |\n",
                  family.name.data(), to_string(start).data(), solved(all, kOurs), request.instances,
                  solved_by_both(all, kIpopt), solved(all, kIpopt), dearer(all, kIpopt, kOurs, kIpopt),
                  dearer(all, kOurs, kIpopt, kIpopt), median_iterations(all), our_time(all, 0.5),
                  our_time(all, 0.99), ratio(all, kIpopt, 0.5), ratio(all, kIpopt, 0.01));
      both += solved_by_both(all, kIpopt);
      reference += solved(all, kIpopt);
      wrong += count(all, &FamilySolve::is_false);
    }
  });
  request.is_impossible = true;
  bool is_first = true;
  each_family(names, [&](const Family& family) {
    for (const NaiveStart start : kStarts) {
      if (!family.has_impossible) continue;
      if (is_first)
        std::printf(
            "\n| family | from | infeasible | usable | iterations | of Ipopt's | further |\n"
            "|---|---|--:|--:|--:|--:|--:|\n");
      is_first = false;
      const FamilySolves all = solve(family, start);
      const auto is_both = [](const FamilySolve& s) {
        return s.by[kOurs].is_impossible && s.by[kIpopt].is_impossible;
      };
      std::printf("| %s | %s | %d of %d | %d | %.0f | %d of %d | %d |\n", family.name.data(),
                  to_string(start).data(), count(all, SolveStatus::kInfeasible), request.instances,
                  count(all, &FamilySolve::is_usable), median_iterations(all), count(all, is_both),
                  count(all, [](const FamilySolve& s) { return s.by[kIpopt].is_impossible; }),
                  count(all, [&](const FamilySolve& s) {
                    return is_both(s) && s.kkt.total > s.by[kIpopt].cost * (1.0 + 1e-4) + 1e-6;
                  }));
    }
  });
  std::printf("%d of the %d that Ipopt solves, %d false\n", both, reference, wrong);
  return wrong == 0 ? 0 : 1;
}

/// Each family at each tolerance, both starts: how many are optimal, at the floor of rounding, within the
/// loose tolerance, and none of these; the largest residual of the first and of the second by the independent
/// check.
int print_tolerances(FamilyRequest request, const Names& names) {
  int wrong = 0;
  std::printf(
      "| family | tolerance | optimal | at floor | near | not | residual | at floor "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  References none;
  request.with_ipopt = false;
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    request.tolerance = tolerance;
    FamilySolves all;
    const auto print = [&](std::string_view name, const FamilySolves& solves) {
      const int optimal = solved(solves, kOurs), at_floor = count(solves, SolveStatus::kAtFloor);
      const int usable = count(solves, &FamilySolve::is_usable);
      std::printf("| %s | %.0e | %d | %d | %d | %d | %.1e | %.1e |\n", name.data(), tolerance, optimal,
                  at_floor, usable - optimal - at_floor, static_cast<int>(solves.size()) - usable,
                  worst_residual(solves, SolveStatus::kOptimal),
                  worst_residual(solves, SolveStatus::kAtFloor));
    };
    each_family(names, [&](const Family& family) {
      FamilySolves both = family.solve(request, NaiveStart::kIdle, none);
      const FamilySolves line = family.solve(request, NaiveStart::kLine, none);
      both.insert(both.end(), line.begin(), line.end());
      all.insert(all.end(), both.begin(), both.end());
      wrong += count(both, &FamilySolve::is_false);
      print(family.name, both);
    });
    print("all", all);
  }
  return wrong == 0 ? 0 : 1;
}

/// Each family in closed loop, beside Ipopt from the same start.
int print_loops(const FamilyRequest& request, const Names& names) {
  std::printf(
      "| family | solved | of Ipopt's | more | iterations | time [ms] | p99 | ratio | p1 | with its "
      "multipliers "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  each_family(names, [&](const Family& family) {
    if (family.drive == nullptr) return;
    const FamilySolves all = family.drive(request);
    std::printf("| %s | %d of %zu | %d of %d | %d | %.0f | %.3f | %.3f | %.0f | %.0f | %.0f |\n",
                family.name.data(), solved(all, kOurs), all.size(), solved_by_both(all, kIpopt),
                solved(all, kIpopt), dearer(all, kOurs, kIpopt, kIpopt), median_iterations(all),
                our_time(all, 0.5), our_time(all, 0.99), ratio(all, kIpopt, 0.5), ratio(all, kIpopt, 0.01),
                ratio(all, kHotIpopt, 0.5));
  });
  return 0;
}

constexpr std::array<const char*, 4> kPeerNames{"ours", "HPIPM", "fatrop", "Ipopt"};

/// The share of instances that each solver has solved within so many times the time of the fastest.
void print_profile(const FamilySolves& all) {
  std::printf("\n| times the fastest |");
  constexpr std::array kTimes{1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0};
  for (const double times : kTimes) std::printf(" %.0f |", times);
  std::printf("\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  const auto time_of = [](const FamilySolve& s, std::size_t peer) {
    const Outcome& outcome = s.by[peer];
    return outcome.is_solved ? outcome.time - outcome.time_in_functions * (peer == kOurs ? 0.0 : 1.0)
                             : std::numeric_limits<double>::infinity();
  };
  for (std::size_t peer = 0; peer < kPeerNames.size(); ++peer) {
    std::printf("| %s |", kPeerNames[peer]);
    for (const double times : kTimes) {
      const int within = count(all, [&](const FamilySolve& s) {
        double fastest = std::numeric_limits<double>::infinity();
        for (std::size_t other = 0; other < kPeerNames.size(); ++other)
          fastest = std::min(fastest, time_of(s, other));
        return s.by[peer].is_solved && time_of(s, peer) <= times * fastest;
      });
      std::printf(" %.0f %% |", 100.0 * within / static_cast<double>(all.size()));
    }
    std::printf("\n");
  }
}
/// Each family beside other solvers; ratios are medians of what both solve.
int print_peers(FamilyRequest request, const Names& names) {
  request.with_peers = true;
  FamilySolves everything;
  std::printf(
      "| family | from | solver | solved | less / more | time over ours | its functions free "
      "|\n|---|---|---|--:|--:|--:|--:|\n");
  each_family(names, [&](const Family& family) {
    for (const NaiveStart start : kStarts) {
      References none;
      const FamilySolves all = family.solve(request, start, none);
      everything.insert(everything.end(), all.begin(), all.end());
      for (std::size_t s = 0; s < kPeerNames.size(); ++s) {
        const Peer peer = static_cast<Peer>(s);
        std::printf("| %s | %s | %s | %d of %zu | %d / %d | %.1f | %.1f |\n", family.name.data(),
                    to_string(start).data(), kPeerNames[s], solved(all, peer), all.size(),
                    dearer(all, kOurs, peer, kOurs), dearer(all, peer, kOurs, kOurs), ratio(all, peer, 0.5),
                    ratio(all, peer, 0.5, true));
      }
    }
  });
  print_profile(everything);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  FamilyRequest request{.with_ipopt = true};
  bool are_tolerances = false, are_loops = false, are_peers = false, each = false;
  std::string file;
  Names names;
  CLI::App app("The solver on families of problems that are no car");
  const CLI::Option* instances = app.add_option("-n", request.instances, "Instances of each family");
  app.add_option("-f", request.first, "Seed of the first one");
  app.add_option("-i", request.ipopt_instances, "Ipopt solves so many of each, and what is not solved");
  app.add_option("-t", request.tolerance, "Tolerance");
  app.add_option("-m", request.max_iterations, "Most iterations");
  app.add_option("--references", file, "File that keeps what Ipopt finds");
  app.add_flag("--each", each, "A line for each instance");
  app.add_flag("--tolerances", are_tolerances, "Statuses and residuals, without Ipopt");
  app.add_flag("--peers", are_peers, "Times beside HPIPM's, fatrop's and Ipopt's");
  app.add_flag("--closed-loop", are_loops, "20 cycles of a controller for each instance");
  app.add_option("names", names, "Families whose name contains one of these");
  CLI11_PARSE(app, argc, argv);
  if (instances->empty() && (are_tolerances || are_loops)) request.instances = are_loops ? 20 : 30;
  if (are_tolerances) return print_tolerances(request, names);
  if (are_peers) return print_peers(request, names);
  if (are_loops) return print_loops(request, names);
  return print_families(request, names, file, each);
}
