// SPDX-License-Identifier: MIT
#include "bench_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench_commit.hpp"

namespace chicane::apps {
namespace {

using Json = nlohmann::ordered_json;

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
      "| family | N | median µs | p99 | p99.9 | p99 / median | turns | unsolved | gradient median / worst |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const SolveRow& row : rows) {
    const SolverColumn& own = row.own;
    text += fmt::format("| {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.1f} | {:.1f} | {} | {} / {} |\n",
                        row.family, row.horizon, own.time_us.median, own.time_us.p99, own.time_us.p999,
                        own.time_us.p99 / own.time_us.median, own.mean_turns, own.unsolved,
                        small(own.median_gradient), small(own.worst_gradient));
  }
  return text;
}

/// "time | ratio | ratio without functions".
std::string against(const std::optional<SolverColumn>& reference, const SolverColumn& own) {
  if (!reference) return "– | – | –";
  return fmt::format("{:.0f} | {:.0f} | {:.0f}", reference->time_us.median,
                     reference->time_us.median / own.time_us.median,
                     reference->linear_us.median / own.time_us.median);
}

std::string ipopt_table(const std::vector<SolveRow>& rows) {
  std::string text =
      "| family | N | Ipopt median µs | ratio | its functions free | hot start µs | ratio | its functions "
      "free "
      "| unsolved | gradient median / worst | our cost over its, worst |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SolveRow& row : rows) {
    if (!row.ipopt) continue;
    text += fmt::format("| {} | {} | {} | {} | {} | {} / {} | {} |\n", row.family, row.horizon,
                        against(row.ipopt, row.own), against(row.ipopt_warm, row.own), row.ipopt->unsolved,
                        small(row.ipopt->median_gradient), small(row.ipopt->worst_gradient),
                        small(row.own.worst_excess));
  }
  return text;
}

std::string step_row(std::string_view name, const Spread& spread) {
  return fmt::format("| {} | {:.0f} | {:.0f} | {:.0f} |\n", name, spread.median, spread.p99, spread.p999);
}

Json json_of(const Spread& spread) {
  return {{"p50", spread.median}, {"p99", spread.p99}, {"p999", spread.p999}};
}

void put(Json& row, const std::string& prefix, const SolverColumn& column) {
  row[prefix + "_p50_us"] = column.time_us.median;
  row[prefix + "_p99_us"] = column.time_us.p99;
  row[prefix + "_p999_us"] = column.time_us.p999;
  if (column.linear_us.median > 0.0) row[prefix + "_without_functions_p50_us"] = column.linear_us.median;
  row[prefix + "_unsolved"] = column.unsolved;
  row[prefix + "_mean_turns"] = column.mean_turns;
  row[prefix + "_median_gradient"] = column.median_gradient;
  row[prefix + "_worst_gradient"] = column.worst_gradient;
  row[prefix + "_worst_excess"] = column.worst_excess;
}

Json json_of(const std::vector<SolveRow>& rows) {
  Json list = Json::array();
  for (const SolveRow& solved : rows) {
    Json row{{"family", solved.family}, {"horizon", solved.horizon}, {"instances", solved.instances}};
    put(row, "own", solved.own);
    if (solved.ipopt) put(row, "ipopt", *solved.ipopt);
    if (solved.ipopt_warm) put(row, "ipopt_hot", *solved.ipopt_warm);
    list.push_back(row);
  }
  return list;
}

}  // namespace

double load() {
  double mean = 0.0;
  return getloadavg(&mean, 1) == 1 ? mean : std::nan("");
}

Machine this_machine() {
  return {.processor = processor(),
          .compiler = CHICANE_COMPILER,
          .flags = CHICANE_FLAGS,
          .commit = CHICANE_COMMIT,
          .date = today(),
          .ipopt = ipopt_version(),
          .load_before = load()};
}

std::string to_markdown(const BenchReport& report) {
  const Machine& machine = report.machine;
  std::string text = fmt::format("{}, {} {}, commit {}, {}; load {:.1f} before, {:.1f} after. Ipopt: {}.\n",
                                 machine.processor, machine.compiler, machine.flags, machine.commit,
                                 machine.date, machine.load_before, machine.load_after,
                                 machine.ipopt.empty() ? "not in this program" : machine.ipopt);
  if (report.was_interrupted) text += "Interrupted: the last row has fewer instances.\n";
  if (!report.solves.empty()) {
    text += fmt::format("{} instances each.\n\n", report.solves.front().instances) + own_table(report.solves);
    if (report.solves.front().ipopt) text += "\n" + ipopt_table(report.solves);
  }
  if (!report.growth.empty()) {
    text += "\nMedian of warm solves against the horizon:";
    for (const SolveRow& row : report.growth) {
      text += fmt::format(" N = {}: {:.0f} µs{}", row.horizon, row.own.time_us.median,
                          &row == &report.growth.back() ? "" : ",");
    }
    text += fmt::format("; exponent {}.\n", number(report.growth_exponent, 2));
  }
  if (report.steps > 0) {
    text += fmt::format("\nControl step of `default` in closed loop, {} steps [µs]:\n\n", report.steps) +
            "| | p50 | p99 | p99.9 |\n|---|---|---|---|\n" +
            step_row("CPU time, one physics step included", report.step_cpu_us) +
            step_row("wall clock", report.step_us) +
            step_row("the optimisation in it, wall clock", report.step_solve_us);
  }
  return text;
}

std::string to_json(const BenchReport& report) {
  const Machine& machine = report.machine;
  const Json json{{"processor", machine.processor},
                  {"compiler", machine.compiler},
                  {"flags", machine.flags},
                  {"commit", machine.commit},
                  {"date", machine.date},
                  {"ipopt", machine.ipopt.empty() ? Json(nullptr) : Json(machine.ipopt)},
                  {"load_before", machine.load_before},
                  {"load_after", machine.load_after},
                  {"interrupted", report.was_interrupted},
                  {"solves", json_of(report.solves)},
                  {"growth", json_of(report.growth)},
                  {"growth_exponent", report.growth_exponent},
                  {"steps", report.steps},
                  {"step_cpu_time_us", json_of(report.step_cpu_us)},
                  {"step_time_us", json_of(report.step_us)},
                  {"solve_time_us", json_of(report.step_solve_us)}};
  return json.dump(2) + "\n";
}

}  // namespace chicane::apps
