// SPDX-License-Identifier: MIT
#include "program/golden.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "chicane/protocol/csv_text.hpp"
#include "problems/cpu_time.hpp"
#include "problems/families.hpp"
#include "problems/optimality.hpp"
#include "problems/structured_solver.hpp"
#include "program/solves.hpp"

namespace chicane::bench {
namespace {

using Table = std::vector<std::vector<double>>;
constexpr double kAgreement = 1e-8;

/// Rows of `columns` numbers behind one heading.
Result<Table> read_table(const std::filesystem::path& file, std::size_t columns) {
  std::ifstream stream(file);
  if (!stream) return fail(ErrorCode::kIo, fmt::format("{}: cannot be read", file.string()));
  Table table;
  std::string line;
  std::getline(stream, line);
  for (int number = 2; std::getline(stream, line); ++number) {
    auto& row = table.emplace_back();
    for (const std::string_view field : protocol::split(line, ',')) {
      const auto value = protocol::number(field);
      if (!value) break;
      row.push_back(*value);
    }
    if (row.size() != columns) {
      return fail(ErrorCode::kParse, fmt::format("{}:{}: got {} numbers, expected {}", file.string(), number,
                                                 row.size(), columns));
    }
  }
  return table;
}

/// Solves each problem of one set from one kind of start.
GoldenRow solve_set(const std::string& set, int nodes, Start start, const Table& cycles, const Table& optima,
                    const std::atomic<bool>& stop) {
  const bool is_cold = start == Start::kCold;
  GoldenRow row{.set = set, .start = is_cold ? "cold0" : "coldP", .nodes = nodes};
  const auto guess = std::make_unique<DescribedTrajectory<kLongestHorizon>>();
  StructuredTrajectory answer;
  std::vector<double> times;
  std::vector<double> steer;
  row.worst_excess = -std::numeric_limits<double>::infinity();
  for (const auto& golden : optima) {
    const auto cycle = static_cast<std::size_t>(golden[0]);
    if (stop || golden[1] != 1.0 || cycle >= cycles.size()) continue;
    const auto& now = cycles[cycle];
    DescribedInstance instance;
    instance.start = {now[0], now[1], now[2], now[3], now[4], now[5], 0.0, 0.0};
    instance.problem.path = {now[6], now[7], now[8], now[9]};
    instance.problem.speed_reference = now[10];
    *guess = {};
    guess->horizon = answer.horizon = nodes - 1;
    if (!is_cold) guess_by_path_law(instance, *guess);
    std::copy_n(guess->u.begin(), guess->horizon, answer.u.begin());
    const StructuredDescribedProblem problem(instance.problem, instance.start[4]);
    const auto x0 = StructuredDescribedProblem::without_cte(instance.start);
    const double begin = cpu_time();
    const solver::SolveReport report = solve_fast(problem, x0, answer);
    times.push_back((cpu_time() - begin) * 1e6);
    ++row.problems;
    row.unsolved += report.status == solver::SolveStatus::kOptimal ? 0 : 1;
    std::copy_n(answer.u.begin(), answer.horizon, guess->u.begin());
    const double cost = simulated_cost(instance.problem, instance.start, *guess);
    const double scale = std::max(1.0, golden[2]);
    double excess = (cost - golden[2]) / scale;
    const bool is_higher = excess > kAgreement;
    if (is_higher)  // the golden optimum is one with bounds moved outwards
      excess -= gain_of_relaxed_bounds(instance.problem, instance.start, *guess) / scale;
    row.worst_excess = std::max(row.worst_excess, excess);
    if (std::fabs(excess) <= kAgreement) {
      ++row.agree;
      row.relaxed += is_higher ? 1 : 0;
      steer.push_back(std::fabs(answer.u[0][0] - golden[3]));
    } else {
      ++(excess < 0.0 ? row.better : row.worse);
    }
  }
  row.median_us = spread_of(std::move(times)).median;
  if (!steer.empty()) row.worst_first_steer = *std::max_element(steer.begin(), steer.end());
  row.median_first_steer = spread_of(std::move(steer)).median;
  return row;
}

}  // namespace

Result<std::vector<GoldenRow>> solve_golden(const std::string& folder, const std::atomic<bool>& stop) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("golden_") && name.ends_with(".csv")) files.push_back(entry.path());
  }
  if (files.empty()) {
    return fail(ErrorCode::kNotFound,
                fmt::format("{}: got no golden_<speed>_N<nodes>.csv in it, expected some", folder));
  }
  std::sort(files.begin(), files.end());
  std::vector<GoldenRow> rows;
  for (const auto& file : files) {
    const std::string set = file.stem().string().substr(std::string("golden_").size());
    const std::size_t split = set.rfind("_N");
    int nodes = 0;
    if (split != std::string::npos) std::from_chars(set.data() + split + 2, set.data() + set.size(), nodes);
    if (nodes < 2 || nodes > kLongestHorizon + 1) {
      return fail(ErrorCode::kParse, fmt::format("{}: got {} nodes in the name, expected 2 to {}",
                                                 file.string(), nodes, kLongestHorizon + 1));
    }
    const auto optima = read_table(file, 6);
    if (!optima) return fail(optima.error());
    const auto cycles = read_table(file.parent_path() / ("lap_" + set.substr(0, split) + ".csv"), 11);
    if (!cycles) return fail(cycles.error());
    fmt::print(stderr, "golden optima {}, {} problems\n", set, optima->size());
    for (const auto start : {Start::kCold, Start::kPathLaw})
      rows.push_back(solve_set(set, nodes, start, *cycles, *optima, stop));
  }
  return rows;
}

}  // namespace chicane::bench
