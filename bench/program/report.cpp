// SPDX-License-Identifier: MIT
#include "program/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench_commit.hpp"
#include "problems/described_problem.hpp"

namespace chicane::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Of the problems that are solved: as controllers instantiate the solver.
static_assert(StructuredDescribedProblem::kRealTime && StructuredCorridorProblem::kRealTime);
constexpr std::string_view kForm =
    "structured problems in real-time form (`kRealTime`: full steps and growing horizons, no filter method), "
    "as `cubic-mpc` drives them";

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "–";
}
std::string small(double value) { return std::isfinite(value) ? fmt::format("{:.0e}", value) : "–"; }

std::string own_table(const std::vector<SolveRow>& rows) {
  std::string text =
      "| family | N | median µs | p99 | p99.9 | p99 / median | iterations | sweeps | unsolved | gradient "
      "median / "
      "worst |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SolveRow& row : rows) {
    const SolverColumn& own = row.own;
    text += fmt::format("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {} | {} / {} |\n",
                        row.family, row.horizon, own.time_us.median, own.time_us.p99, own.time_us.p999,
                        own.time_us.p99 / own.time_us.median, own.mean_iterations, own.mean_sweeps,
                        own.unsolved, small(own.median_gradient), small(own.worst_gradient));
  }
  return text;
}

double ratio(const SolverColumn* reference, const SolverColumn& own) {
  return reference == nullptr ? std::nan("") : reference->time_us.median / own.time_us.median;
}

/// Median time without the problem's functions, where it is measured.
double functions_free(const SolverColumn& column) {
  return column.without_functions_us > 0.0 ? column.without_functions_us : column.time_us.median;
}

std::string reference_table(const std::vector<SolveRow>& rows) {
  std::string text =
      "| family | N | solver | median µs | p99 | ratio | ratio, its functions free | iterations | unsolved | "
      "gradient median / worst | our cost over its, worst |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SolveRow& row : rows) {
    for (const SolverColumn& column : row.references) {
      const double free = column.without_functions_us / row.own_shared.time_us.median;
      text += fmt::format("| {} | {} | {} | {:.0f} | {:.0f} | {:.0f} | {} | {:.1f} | {} | {} / {} | {} |\n",
                          row.family, row.horizon, column.name, column.time_us.median, column.time_us.p99,
                          ratio(&column, row.own_shared), free > 0.0 ? number(free, 0) : "–",
                          column.mean_iterations, column.unsolved, small(column.median_gradient),
                          small(column.worst_gradient), small(column.worst_excess));
    }
  }
  return text;
}

std::string target_table(const std::vector<Target>& rows) {
  std::string text = "| what | promised | aim | measured | kept |\n|---|---|---|---|---|\n";
  for (const Target& row : rows) {
    const char* sign = row.is_ceiling ? "<=" : ">=";
    const char* verdict = std::isnan(row.measured) ? "not measured" : row.is_kept() ? "yes" : "no";
    text += fmt::format("| {} | {} {:g} | {:g} | {} | {} |\n", row.what, sign, row.least, row.aim,
                        std::isfinite(row.measured) ? fmt::format("{:.4g}", row.measured) : "–", verdict);
  }
  return text;
}

const SolveRow* row_of(const std::vector<SolveRow>& rows, std::string_view family, int horizon) {
  for (const SolveRow& row : rows) {
    if (row.family == family && row.horizon == horizon) return &row;
  }
  return nullptr;
}

std::string step_row(std::string_view name, const Spread& spread) {
  return fmt::format("| {} | {:.0f} | {:.0f} | {:.0f} |\n", name, spread.median, spread.p99, spread.p999);
}

std::string step_rows(std::string_view name, const StepTimes& times) {
  return step_row(fmt::format("{}: CPU time, one physics step included", name), times.cpu_us) +
         step_row(fmt::format("{}: wall clock", name), times.wall_us) +
         step_row(fmt::format("{}: the optimisation in it, wall clock", name), times.solve_us);
}

Json json_of(const Spread& spread) {
  return {{"p50", spread.median}, {"p99", spread.p99}, {"p999", spread.p999}};
}

Json json_of(const StepTimes& times) {
  return {{"steps", times.steps},
          {"cpu_time_us", json_of(times.cpu_us)},
          {"wall_time_us", json_of(times.wall_us)},
          {"solve_time_us", json_of(times.solve_us)}};
}

void put(Json& row, const SolverColumn& column) {
  const std::string& prefix = column.name;
  row[prefix + "_p50_us"] = column.time_us.median;
  row[prefix + "_p99_us"] = column.time_us.p99;
  row[prefix + "_p999_us"] = column.time_us.p999;
  if (column.without_functions_us > 0.0)
    row[prefix + "_without_functions_p50_us"] = column.without_functions_us;
  row[prefix + "_unsolved"] = column.unsolved;
  row[prefix + "_mean_iterations"] = column.mean_iterations;
  if (column.mean_sweeps > 0.0) row[prefix + "_mean_sweeps"] = column.mean_sweeps;
  row[prefix + "_median_gradient"] = column.median_gradient;
  row[prefix + "_worst_gradient"] = column.worst_gradient;
  if (prefix != "own") row["worst_excess_over_" + prefix] = column.worst_excess;
}

Json json_of(const std::vector<SolveRow>& rows) {
  Json list = Json::array();
  for (const SolveRow& solved : rows) {
    Json row{{"family", solved.family},
             {"horizon", solved.horizon},
             {"instances", solved.instances},
             {"own_instances", solved.own_instances}};
    put(row, solved.own);
    for (const SolverColumn& column : solved.references) put(row, column);
    list.push_back(row);
  }
  return list;
}

Json json_of(const std::vector<Target>& rows) {
  Json list = Json::array();
  for (const Target& row : rows) {
    list.push_back({{"what", row.what},
                    {"promised", row.least},
                    {"aim", row.aim},
                    {"is_ceiling", row.is_ceiling},
                    {"measured", std::isfinite(row.measured) ? Json(row.measured) : Json(nullptr)},
                    {"is_kept", row.is_kept()}});
  }
  return list;
}

}  // namespace

double load() {
  double mean = 0.0;
  return getloadavg(&mean, 1) == 1 ? mean : std::nan("");
}

std::vector<Target> targets(const BenchReport& report) {
  std::vector<Target> list;
  const auto add = [&](std::string what, double least, double aim, bool is_ceiling, double measured) {
    list.push_back({std::move(what), least, aim, is_ceiling, measured});
  };
  const SolverColumn nothing{.name = "", .time_us = {std::nan(""), std::nan(""), std::nan("")}};
  const auto own = [&](std::string_view family, int horizon) -> const SolverColumn& {
    const SolveRow* row = row_of(report.solves, family, horizon);
    return row == nullptr ? nothing : row->own;
  };
  const auto against = [&](std::string_view family, std::string_view name) {
    const SolveRow* row = row_of(report.solves, family, 20);
    const SolverColumn* column = row == nullptr ? nullptr : row->reference(name);
    return column == nullptr ? std::nan("") : functions_free(*column) / row->own_shared.time_us.median;
  };
  for (const std::string_view family : {"cold0", "coldP", "warm"}) {
    const bool is_warm = family == "warm";
    add(fmt::format("{}, N = 20, median [µs]", family), is_warm ? 6 : 10, is_warm ? 3 : 5, true,
        own(family, 20).time_us.median);
    add(fmt::format("{}, N = 20, p99 over median", family), 2, 1.6, true,
        own(family, 20).time_us.p99 / own(family, 20).time_us.median);
    add(fmt::format("{}, N = 20, times faster than Ipopt, its functions free", family), 800, 1500, false,
        against(family, "ipopt"));
  }
  add("warm, N = 20, times faster than Ipopt from its multipliers, its functions free", 400, 800, false,
      against("warm", "ipopt_hot"));
  add("corridor-warm, N = 20, median [µs]", 15, 10, true, own("corridor-warm", 20).time_us.median);
  add("corridor-warm, N = 40, median [µs]", 35, 25, true, own("corridor-warm", 40).time_us.median);
  add("warm, N = 20, time of the dense form over the structured one", 3, 2, true, against("warm", "dense"));
  double unsolved = 0.0;
  for (const SolveRow& row : report.solves) unsolved += row.own.unsolved;
  add("problems not solved", 0, 0, true, report.solves.empty() ? std::nan("") : unsolved);
  const StepTimes& guarded = report.with_guard;
  const StepTimes& bare = report.without_guard;
  add("control step of default without guard, p99.9 of CPU time [µs]", 100, 40, true,
      bare.steps > 0 ? bare.cpu_us.p999 : std::nan(""));
  add("control step of default with guard, p99.9 of CPU time [µs]", 100, 40, true,
      guarded.steps > 0 ? guarded.cpu_us.p999 : std::nan(""));
  return list;
}

Machine this_machine(const References& references) {
  return {.processor = processor(),
          .compiler = CHICANE_COMPILER,
          .flags = CHICANE_FLAGS,
          .commit = CHICANE_COMMIT,
          .date = today(),
          .references = references.versions,
          .load_before = load()};
}

std::string to_markdown(const BenchReport& report) {
  const Machine& machine = report.machine;
  std::string text = fmt::format(
      "{}, {} {}, commit {}, {}; load {:.1f} before, {:.1f} after. Compared with: {}.\n", machine.processor,
      machine.compiler, machine.flags, machine.commit, machine.date, machine.load_before, machine.load_after,
      machine.references.empty() ? "nothing" : machine.references);
  if (report.was_interrupted) text += "Interrupted: the last row has fewer instances.\n";
  if (!report.solves.empty()) {
    const SolveRow& first = report.solves.front();
    text += fmt::format("Ours: {}. {} instances each; all solvers have solved the first {} of them.\n\n",
                        kForm, first.own_instances, first.instances) +
            own_table(report.solves);
    text += "\n" + reference_table(report.solves);
  }
  if (report.with_guard.steps > 0) {
    text += fmt::format(
                "\nControl step of `default` in closed loop, {} steps with the guard and {} without "
                "(`guard.mode=off`), each the least of three [µs]:\n\n",
                report.with_guard.steps, report.without_guard.steps) +
            "| | p50 | p99 | p99.9 |\n|---|---|---|---|\n" + step_rows("with guard", report.with_guard) +
            step_rows("without guard", report.without_guard);
  }
  text += "\n" + target_table(targets(report));
  return text;
}

std::string to_json(const BenchReport& report) {
  const Machine& machine = report.machine;
  const Json json{{"processor", machine.processor},
                  {"compiler", machine.compiler},
                  {"flags", machine.flags},
                  {"commit", machine.commit},
                  {"date", machine.date},
                  {"references", machine.references},
                  {"load_before", machine.load_before},
                  {"load_after", machine.load_after},
                  {"interrupted", report.was_interrupted},
                  {"solves", json_of(report.solves)},
                  {"form", kForm},
                  {"step_with_guard", json_of(report.with_guard)},
                  {"step_without_guard", json_of(report.without_guard)},
                  {"targets", json_of(targets(report))}};
  return json.dump(2) + "\n";
}

}  // namespace chicane::bench
