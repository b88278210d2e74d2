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
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "families/list.hpp"

namespace {

using namespace chicane::bench;

References read(const std::string& file) {
  References references;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    const auto tab = line.rfind('\t');
    int is_solved = 0;
    ReferenceAnswer answer;
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
  std::ofstream out(file);
  for (const auto& [key, answer] : references) {
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, "%d %.17g %.6g %d",
                  answer.is_impossible ? 2 : (answer.is_solved ? 1 : 0), answer.cost, answer.time,
                  answer.iterations);
    out << key << '\t' << numbers << '\n';
  }
}

void print_head() {
  std::printf(
      "| family | from | solved | of Ipopt's | less / more | iterations | time [ms] | p99 | ratio | p1 |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
}
void print(const FamilyRow& row) {
  std::printf("| %s | %s | %d of %d | %d of %d | %d / %d | %.0f | %.2f | %.2f | %.0f | %.0f |\n",
              row.family.data(), to_string(row.start).data(), row.optimal, row.instances, row.both,
              row.reference, row.lower, row.higher, row.iterations, 1e3 * row.time, 1e3 * row.most_time,
              row.ratio, row.least_ratio);
  std::fflush(stdout);
}
/// Counts of infeasible and of usable answers of problems without a solution, and of points with larger
/// misses than Ipopt's.
void print_infeasible(const std::vector<FamilyRow>& rows) {
  bool is_first = true;
  for (const FamilyRow& row : rows) {
    if (is_first)
      std::printf(
          "\n| family | from | infeasible | usable | iterations | of Ipopt's | further "
          "|\n|---|---|--:|--:|--:|--:|--:|\n");
    is_first = false;
    std::printf("| %s | %s | %d of %d | %d | %.0f | %d of %d | %d |\n", row.family.data(),
                to_string(row.start).data(), row.infeasible, row.instances, row.usable, row.iterations,
                row.both_infeasible, row.reference_infeasible, row.further);
  }
}

bool is_wanted(const Family& family, const std::vector<std::string>& names) {
  bool is_named = names.empty();
  for (const std::string& name : names)
    is_named = is_named || family.name.find(name) != std::string_view::npos;
  return is_named;
}

/// Each family at each tolerance, both starts: how many are optimal, at the floor of rounding, within the
/// loose tolerance, and none of these; the largest residual of the first and of the second by the independent
/// check.
int print_tolerances(FamilyRequest request, const std::vector<std::string>& names) {
  int wrong = 0;
  std::printf(
      "| family | tolerance | optimal | at floor | near | not | residual | at floor "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  References none;
  request.with_ipopt = false;
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    request.tolerance = tolerance;
    FamilyRow all{.family = "all"};
    const auto print_row = [&](const FamilyRow& row) {
      std::printf("| %s | %.0e | %d | %d | %d | %d | %.1e | %.1e |\n", row.family.data(), tolerance,
                  row.optimal, row.at_floor, row.usable - row.optimal - row.at_floor,
                  row.instances - row.usable, row.worst_residual, row.floor_residual);
      std::fflush(stdout);
    };
    for (const Family& family : all_families()) {
      if (!is_wanted(family, names)) continue;
      FamilyRow both{.family = family.name};
      for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
        const FamilyRow row = family.measure(request, start, none);
        for (FamilyRow* sum : {&both, &all}) {
          sum->instances += row.instances;
          sum->optimal += row.optimal;
          sum->at_floor += row.at_floor;
          sum->usable += row.usable;
          sum->worst_residual = std::max(sum->worst_residual, row.worst_residual);
          sum->floor_residual = std::max(sum->floor_residual, row.floor_residual);
        }
        wrong += row.false_optimal;
      }
      print_row(both);
    }
    print_row(all);
  }
  return wrong == 0 ? 0 : 1;
}

/// Each family in closed loop, beside Ipopt from the same start.
int print_loops(const FamilyRequest& request, const std::vector<std::string>& names) {
  std::printf(
      "| family | solved | of Ipopt's | more | iterations | time [ms] | p99 | ratio | p1 | with its "
      "multipliers "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Family& family : all_families()) {
    if (!is_wanted(family, names) || family.drive == nullptr) continue;
    const LoopRow row = family.drive(request);
    std::printf("| %s | %d of %d | %d of %d | %d | %.0f | %.3f | %.3f | %.0f | %.0f | %.0f |\n",
                row.family.data(), row.optimal, row.solves, row.both, row.reference, row.higher,
                row.iterations, 1e3 * row.time, 1e3 * row.most_time, row.ratio, row.least_ratio,
                row.warm_ratio);
    std::fflush(stdout);
  }
  return 0;
}

using Compared = std::vector<std::array<SolveTime, kSolvers.size()>>;

/// The share of instances that each solver has solved within so many times the time of the fastest.
void print_profile(const Compared& all) {
  std::printf("\n| times the fastest |");
  constexpr std::array kTimes{1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0};
  for (const double times : kTimes) std::printf(" %.0f |", times);
  std::printf("\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (std::size_t s = 0; s < kSolvers.size(); ++s) {
    std::printf("| %s |", kSolvers[s]);
    for (const double times : kTimes) {
      const auto count = std::count_if(all.begin(), all.end(), [&](const auto& one) {
        const auto less = [](const SolveTime& a, const SolveTime& b) { return a.free < b.free; };
        return one[s].total < 1e30 &&
               one[s].free <= times * std::min_element(one.begin(), one.end(), less)->free;
      });
      std::printf(" %.0f %% |", 100.0 * static_cast<double>(count) / static_cast<double>(all.size()));
    }
    std::printf("\n");
  }
}
/// Each family beside other solvers; ratios are medians of what both solve.
int print_peers(FamilyRequest request, const std::vector<std::string>& names) {
  request.with_peers = true;
  Compared everything;
  std::printf(
      "| family | from | solver | solved | less / more | time over ours | its functions free "
      "|\n|---|---|---|--:|--:|--:|--:|\n");
  for (const Family& family : all_families()) {
    if (!is_wanted(family, names)) continue;
    for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
      References none;
      const Compared all = family.measure(request, start, none).compared;
      everything.insert(everything.end(), all.begin(), all.end());
      for (std::size_t s = 0; s < kSolvers.size(); ++s) {
        std::vector<double> total, free;
        long solved = 0, less = 0, more = 0;
        for (const auto& one : all) {
          const double margin = 1e-2 * std::fabs(one[0].cost) + 1e-6;
          solved += one[s].total < 1e30 ? 1 : 0;
          if (!(one[s].total < 1e30 && one[0].total < 1e30)) continue;
          total.push_back(one[s].total / one[0].total);
          free.push_back(one[s].free / one[0].total);
          less += one[s].cost < one[0].cost - margin ? 1 : 0;
          more += one[s].cost > one[0].cost + margin ? 1 : 0;
        }
        std::printf("| %s | %s | %s | %ld of %zu | %ld / %ld | %.1f | %.1f |\n", family.name.data(),
                    to_string(start).data(), kSolvers[s], solved, all.size(), less, more,
                    detail::at_share(total, 0.5), detail::at_share(free, 0.5));
        std::fflush(stdout);
      }
    }
  }
  print_profile(everything);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  FamilyRequest request{.with_ipopt = true};
  bool are_tolerances = false, are_loops = false, are_peers = false;
  std::string file;
  std::vector<std::string> names;
  CLI::App app("The solver on families of problems that are no car");
  const CLI::Option* instances = app.add_option("-n", request.instances, "Instances of each family");
  app.add_option("-f", request.first, "Seed of the first one");
  app.add_option("-i", request.ipopt_instances, "Ipopt solves so many of each, and what is not solved");
  app.add_option("-t", request.tolerance, "Tolerance");
  app.add_option("-m", request.max_iterations, "Most iterations");
  app.add_option("--references", file, "File that keeps what Ipopt finds");
  app.add_flag("--each", request.each, "A line for each instance");
  app.add_flag("--tolerances", are_tolerances, "Statuses and residuals, without Ipopt");
  app.add_flag("--peers", are_peers, "Times beside HPIPM's, fatrop's and Ipopt's");
  app.add_flag("--closed-loop", are_loops, "20 cycles of a controller for each instance");
  app.add_option("names", names, "Families whose name contains one of these");
  CLI11_PARSE(app, argc, argv);
  if (instances->empty() && (are_tolerances || are_loops)) request.instances = are_loops ? 20 : 30;
  if (are_tolerances) return print_tolerances(request, names);
  if (are_peers) return print_peers(request, names);
  if (are_loops) return print_loops(request, names);
  References references = read(file);
  print_head();
  int both = 0, reference = 0, wrong = 0;
  std::vector<FamilyRow> impossible;
  for (const Family& family : all_families()) {
    if (!is_wanted(family, names)) continue;
    for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine}) {
      const FamilyRow row = family.measure(request, start, references);
      print(row);
      both += row.both;
      reference += row.reference;
      wrong += row.false_optimal;
      if (!file.empty()) write(references, file);
    }
  }
  request.is_impossible = true;
  for (const Family& family : all_families()) {
    if (!is_wanted(family, names) || !family.has_impossible) continue;
    for (const NaiveStart start : {NaiveStart::kIdle, NaiveStart::kLine})
      impossible.push_back(family.measure(request, start, references));
  }
  if (!file.empty()) write(references, file);
  print_infeasible(impossible);
  std::printf("%d of the %d that Ipopt solves, %d false\n", both, reference, wrong);
  return wrong == 0 ? 0 : 1;
}
