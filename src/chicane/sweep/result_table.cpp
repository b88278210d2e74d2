// SPDX-License-Identifier: MIT
#include "chicane/sweep/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

/// Figures of one run that are compared.
struct ComparedRun {
  std::vector<double> laps{};  ///< times [s]
  std::int64_t off = 0;        ///< times off the road
  bool is_completed = false;
  std::string reasons{};  ///< reasons of the guard with their steps
  std::string error{};    ///< it could not be driven

  [[nodiscard]] bool is_clean() const { return error.empty() && is_completed && off == 0; }
  [[nodiscard]] double mean(std::size_t count) const {
    return std::accumulate(laps.begin(), laps.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
           static_cast<double>(count);
  }
  [[nodiscard]] std::string laps_text() const {
    if (!error.empty()) return error;
    if (laps.empty()) return "no lap";
    return fmt::format("{:.2f} · {:.2f} · {:.2f}{}", laps.front(),
                       *std::min_element(laps.begin(), laps.end()), mean(laps.size()),
                       is_completed ? "" : fmt::format(" ({} laps)", laps.size()));
  }
};

ComparedRun compared_run(const Json& json) {
  ComparedRun run{.off = json.value("off_track_events", std::int64_t{0}),
                  .is_completed = json.value("completed", false),
                  .error = json.value("error", "")};
  const Json laps = json.value("lap_times_s", Json::array());
  for (const Json& lap : laps)
    if (lap.is_number()) run.laps.push_back(lap.get<double>());
  const Json reasons = json.value("guard_reasons", Json::object());
  for (const auto& [reason, steps] : reasons.items())
    run.reasons +=
        fmt::format("{}`{}` {}", run.reasons.empty() ? "" : ", ", reason, steps.get<std::int64_t>());
  return run;
}

/// Why `run` is worse than `other`; empty: it is not.
std::string worse_text(const ComparedRun& run, const ComparedRun& other) {
  if (!other.is_clean()) return "";
  if (!run.error.empty()) return "cannot be driven";
  if (run.off > 0) return "off the road";
  if (!run.is_completed) return "not completed";
  const std::size_t laps = std::min(run.laps.size(), other.laps.size());
  if (laps == 0) return "";
  const double slower = run.mean(laps) / other.mean(laps) - 1.0;
  return slower > kSlower ? fmt::format("{:.1f} % slower", 100.0 * slower) : "";
}

/// Runs by what they have in common, in the order of the plan, and by the value that is compared.
struct ComparedRuns {
  std::vector<std::string> keys{};  ///< of what they have in common
  std::map<std::uint64_t, std::map<std::string, ComparedRun>> by_first_run{};
  std::map<std::vector<std::string>, std::uint64_t> first_run{};
};

std::string setting_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : protocol::json_text(value);
}

Result<void> add_results(const std::string& file, const std::string& key, ComparedRuns& found) {
  const auto check = [&](const Header& header) -> Result<void> {
    if (std::find(header.keys.begin(), header.keys.end(), key) != header.keys.end()) return {};
    return fail(
        refusal("--compare", key, fmt::format("an axis of the sweep: {}", fmt::join(header.keys, ", "))));
  };
  const auto add = [&](std::uint64_t run, const Json& json) -> Result<void> {
    try {
      std::vector<std::string> common, keys;
      std::string value;
      for (const auto& [name, setting] : json.at("settings").items()) {
        if (name != key) keys.push_back(name);
        if (name != key) common.push_back(setting_text(setting));
        if (name == key) value = setting_text(setting);
      }
      if (found.keys.empty()) found.keys = keys;
      const auto first = found.first_run.emplace(std::move(common), run).first;
      found.by_first_run[first->second][value] = compared_run(json);
    } catch (const Json::exception&) {
      return fail(ErrorCode::kParse,
                  fmt::format("got {}, expected results", printable(protocol::json_text(json))));
    }
    return {};
  };
  return read_runs(file, check, add);
}

/// A text as it is, all else as JSON; nothing for null.
std::string cell_of(const Json& value) { return value.is_null() ? "" : csv_cell(setting_text(value)); }

std::string table_head(const ComparedRuns& found, const std::string& key, const std::string& value) {
  std::string text = "|";
  for (const std::string& each : found.keys) text += fmt::format(" {} |", each);
  text += fmt::format(
      " {} | laps [s]: first · best · mean | with {} | off the road | with {} | the guard found | worse |\n|",
      key, value, value);
  for (std::size_t i = 0; i < found.keys.size(); ++i) text += "---|";
  return text + "---|--:|--:|--:|--:|---|---|\n";
}

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

Result<void> write_csv(const std::string& results, const std::string& csv) {
  FileWriter out(csv);
  Header columns;
  const auto write_head = [&](const Header& header) -> Result<void> {
    columns = header;
    std::string row = "run";
    for (const std::string& key : header.keys) row += ',' + cell_of(key);
    for (const std::string& column : header.columns) row += ',' + cell_of(column);
    out.write(row + ",error\r\n");
    return {};
  };
  const auto write_run = [&](std::uint64_t number, const Json& run) -> Result<void> {
    const Json settings = run.value("settings", Json::object());
    std::string row = std::to_string(number);
    for (const std::string& key : columns.keys) row += ',' + cell_of(settings.value(key, Json()));
    for (const std::string& column : columns.columns) row += ',' + cell_of(run.value(column, Json()));
    out.write(row + ',' + cell_of(run.value("error", Json())) + "\r\n");
    return out.check();
  };
  const Result<void> read = read_runs(results, write_head, write_run);
  return read ? out.finish() : fail(read.error());
}

Result<Comparison> compare(const std::vector<std::string>& results, const std::string& key,
                           const std::string& value) {
  ComparedRuns found;
  for (const std::string& file : results)
    if (const Result<void> added = add_results(file, key, found); !added) return fail(added.error());
  std::map<std::uint64_t, const std::vector<std::string>*> names;
  for (const auto& [common, run] : found.first_run) names[run] = &common;
  Comparison comparison{.table = table_head(found, key, value)};
  for (const auto& [first, runs] : found.by_first_run) {
    const auto other = runs.find(value);
    if (other == runs.end() || runs.size() == 1) {
      ++comparison.missing;
      continue;
    }
    for (const auto& [mine, run] : runs) {
      if (mine == value) continue;
      const std::string worse = worse_text(run, other->second);
      ++comparison.pairs;
      if (!worse.empty()) ++comparison.worse;
      comparison.table += "|";
      for (const std::string& name : *names[first]) comparison.table += fmt::format(" `{}` |", name);
      comparison.table += fmt::format(" {} | {} | {} | {} | {} | {} | {} |\n", mine, run.laps_text(),
                                      other->second.laps_text(), run.off, other->second.off, run.reasons,
                                      worse.empty() ? "" : "**" + worse + "**");
    }
  }
  return comparison;
}

}  // namespace chicane::sweep
