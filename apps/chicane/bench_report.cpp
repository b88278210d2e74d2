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

std::string ratio(double reference, double own) {
  return reference > 0.0 ? fmt::format("{:.0f}", reference / own) : "–";
}

std::string solve_row(const SolveRow& row) {
  const SolverColumn& own = row.own;
  std::string text =
      fmt::format("| {} | {} | {} | {} | {} | {} | {:.1f} | {} | {} / {} ", row.family, row.horizon,
                  number(own.time_us.median, 0), number(own.time_us.p99, 0), number(own.time_us.p999, 0),
                  number(own.time_us.p99 / own.time_us.median, 1), own.mean_turns, own.unsolved,
                  small(own.median_gradient), small(own.worst_gradient));
  if (!row.ipopt) return text + "|\n";
  const SolverColumn& other = *row.ipopt;
  text += fmt::format("| {} | {} | {} / {} | {} | {} | {} ", number(other.time_us.median, 0), other.unsolved,
                      small(other.median_gradient), small(other.worst_gradient), small(own.worst_excess),
                      ratio(other.time_us.median, own.time_us.median),
                      ratio(other.linear_us.median, own.time_us.median));
  if (!row.ipopt_warm) return text + "| – | – | – |\n";
  const SolverColumn& warm = *row.ipopt_warm;
  return text + fmt::format("| {} | {} | {} |\n", number(warm.time_us.median, 0),
                            ratio(warm.time_us.median, own.time_us.median),
                            ratio(warm.linear_us.median, own.time_us.median));
}

std::string solve_table(const BenchReport& report) {
  std::string head =
      "| family | N | median µs | p99 | p99.9 | p99/median | turns | unsolved | gradient median / worst ";
  std::string line = "|---|---|---|---|---|---|---|---|---|";
  if (!report.solves.empty() && report.solves.front().ipopt) {
    head +=
        "| Ipopt median µs | unsolved | gradient median / worst | own cost over its, worst | ratio | without "
        "functions | Ipopt hot µs | ratio | without functions ";
    line += "---|---|---|---|---|---|---|---|---|";
  }
  std::string text = head + "|\n" + line + "\n";
  for (const SolveRow& row : report.solves) text += solve_row(row);
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
    text += fmt::format("{} instances each.\n\n", report.solves.front().instances) + solve_table(report);
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
