// SPDX-License-Identifier: MIT
// `chicane claims`: tries the statements of write-ups on several tracks and in several readings of speed, and
// writes the page of verdicts or compares it. The trials are runs of one plan.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/data_folders.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/sweep/claim.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/sweep.hpp"
#include "chicane/sweep/trial.hpp"
#include "commands.hpp"
#include "lab/many_runs.hpp"

namespace chicane::apps {
namespace {

using sweep::Claim;
using sweep::Settings;

/// Waypoint file of the course: not shipped, tools/fetch_circuits.sh fetches it.
constexpr std::string_view kCourseFile = "circuits/lake_track_waypoints.csv";

/// Reading of the speeds in a write-up: settings that say which of them are in miles per hour.
struct Reading {
  std::string_view name;
  Settings settings;
};
/// All readings.
const std::array<Reading, 3>& readings() {
  static const std::array<Reading, 3> kReadings{
      {{"SI", {{"cubic_mpc.speed_in_mph", "false"}, {"cubic_mpc.roll_forward_in_mph", "false"}}},
       {"mph in the model", {{"cubic_mpc.speed_in_mph", "true"}, {"cubic_mpc.roll_forward_in_mph", "false"}}},
       {"mph throughout", {{"cubic_mpc.speed_in_mph", "true"}, {"cubic_mpc.roll_forward_in_mph", "true"}}}}};
  return kReadings;
}

/// Reading of the claim's preset.
const Reading& own_reading(const Claim& claim) {
  const auto scenario = sweep::scenario_of(claim.settings);
  const auto is_set = [&](const char* key) {
    return scenario && protocol::get_text(*scenario, *protocol::find(key)) == "true";
  };
  const bool is_throughout = is_set("cubic_mpc.roll_forward_in_mph");
  return readings()[is_throughout ? 2 : is_set("cubic_mpc.speed_in_mph") ? 1 : 0];
}

/// Track on which claims are tried.
struct Lake {
  std::string_view name;           ///< name in the page
  std::string track;               ///< name or file
  bool is_in_all_readings = true;  ///< false: tried in the reading of the claim's preset alone
  bool is_there = true;            ///< false: its file is missing

  /// Whether a claim is tried on it in a reading.
  [[nodiscard]] bool takes(const Claim& claim, const Reading& reading) const {
    return is_there && (is_in_all_readings || reading.name == own_reading(claim).name);
  }
};
constexpr std::size_t kLakes = 3;
/// All tracks; verdicts count the first two, which ship.
const std::array<Lake, kLakes>& lakes() {
  static const std::array<Lake, kLakes> kAll = [] {
    std::error_code error;
    return std::array<Lake, kLakes>{
        {{"lakeside", "lakeside"},
         {"original lake", "original-lake"},
         {"course's file", std::string(kCourseFile), false, std::filesystem::exists(kCourseFile, error)}}};
  }();
  return kAll;
}

/// Claims of all files in a folder, sorted by file name. `wanted`: ids to keep; empty: all. Without the
/// default folder, those of the installation.
Result<std::vector<Claim>> read_claims(const std::string& folder, const std::vector<std::string>& wanted) {
  std::vector<std::string> folders, files;
  if (folder == Options::Claims{}.folder)
    folders = protocol::data_folders(protocol::data_origins(), "claims");
  folders.insert(folders.begin(), folder);
  std::error_code error;
  for (std::size_t i = 0; i < folders.size() && files.empty(); ++i)
    for (const auto& entry : std::filesystem::directory_iterator(folders[i], error))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  if (files.empty())
    return fail(ErrorCode::kNotFound,
                fmt::format("{}: got no claims, expected a folder with *.yaml", folder));
  std::sort(files.begin(), files.end());
  std::vector<Claim> claims;
  for (const std::string& file : files) {
    const Result<std::string> text = protocol::read_file(file);
    if (!text) return fail(text.error());
    const std::string quotations = protocol::read_file(sweep::quotations_file(file)).value_or("");
    Result<std::vector<Claim>> read = sweep::parse_claims(*text, file, quotations);
    if (!read) return fail(read.error());
    for (Claim& claim : *read) {
      const bool is_wanted =
          wanted.empty() || std::find(wanted.begin(), wanted.end(), claim.id) != wanted.end();
      if (is_wanted) claims.push_back(std::move(claim));
    }
  }
  if (claims.empty())
    return fail(ErrorCode::kNotFound, fmt::format("claims: got none of {}", fmt::join(wanted, ", ")));
  return claims;
}

/// Settings of one case on one track in one reading. Settings of the claim win over those of the reading.
Settings settings_of(const Claim& claim, const sweep::Case& each, const Lake& lake, const Reading& reading) {
  Settings settings{{"guard.mode", "off"}, {"laps", "3"}, {"time_limit_s", "400"}, {"track", lake.track}};
  settings.insert(settings.end(), reading.settings.begin(), reading.settings.end());
  settings.insert(settings.end(), claim.settings.begin(), claim.settings.end());
  settings.insert(settings.end(), each.settings.begin(), each.settings.end());
  return settings;
}

/// Runs of all claims, by their command: claims with equal commands share a run.
class Trials {
 public:
  void add(const Settings& settings) { wanted_.emplace(sweep::command_of(settings), settings); }

  /// Drives all added runs. False if they were stopped.
  Result<bool> drive(int jobs, const std::string& results, const std::atomic<bool>& stop) {
    sweep::Axis axis = sweep::list_axis("trial", {});
    axis.size = wanted_.size();
    sweep::Dimension& trials = axis.dimensions.front();
    for (const auto& [command, settings] : wanted_) {
      trials.list.push_back(std::to_string(trials.list.size()));
      trials.cases.push_back(settings);
    }
    PlanRuns runs;
    runs.plan.name = "claims";
    runs.plan.axes = {std::move(axis)};
    const Result<RunLines> driven = drive_runs(runs, jobs, results, stop);
    if (!driven) return fail(driven.error());
    std::uint64_t run = 0;
    for (const auto& [command, settings] : wanted_) {
      const auto line = driven->lines.find(run++);
      if (line != driven->lines.end()) lines_[command] = line->second;
    }
    return driven->progress.is_complete();
  }

  /// Line of results of a run. Pre: it was driven.
  [[nodiscard]] const protocol::Json& of(const Settings& settings) const {
    return lines_.at(sweep::command_of(settings));
  }

  /// Added runs by command.
 private:
  std::map<std::string, Settings> wanted_;
  std::map<std::string, protocol::Json> lines_;  ///< lines of results by command
};

/// Whether a claim holds on one track, for each reading; none for a reading that is not tried.
using Marks = std::array<std::optional<bool>, 3>;

/// Marks of a claim on a track.
Marks marks_of(const Claim& claim, const Trials& trials, const Lake& lake) {
  Marks marks;
  for (std::size_t r = 0; r < readings().size(); ++r) {
    if (!lake.takes(claim, readings()[r])) continue;
    sweep::CaseResults results;
    for (const sweep::Case& each : claim.cases)
      results[each.name] = trials.of(settings_of(claim, each, lake, readings()[r]));
    marks[r] = sweep::holds(claim, results);
  }
  return marks;
}

/// Marks as text: "yes · no · yes".
std::string cell_of(const Marks& marks) {
  std::string cell;
  for (const auto& mark : marks)
    if (mark) cell += fmt::format("{}{}", cell.empty() ? "" : " · ", *mark ? "yes" : "no");
  return cell;
}

/// Verdict in words: true, false, not reproduced with our values, or what the outcome depends on. `lakeside`,
/// `original`: cells of the two tracks that ship.
std::string verdict_of(const Claim& claim, const std::string& lakeside, const std::string& original) {
  const std::string all = lakeside + original;
  if (all.find("no") == std::string::npos) return "**true**";
  if (all.find("yes") == std::string::npos)
    return claim.ours.empty() ? "**false**" : fmt::format("**not reproduced** {}", claim.ours);
  if (lakeside == original) return "depends on the reading of speed";
  const auto is_even = [](const std::string& cell) {
    return cell.find("yes") == std::string::npos || cell.find("no") == std::string::npos;
  };
  return is_even(lakeside) && is_even(original) ? "depends on the lake" : "depends on lake and reading";
}

/// Number with three or four digits; a dash if it was not measured.
std::string figure(double value) {
  return std::isnan(value)
             ? "–"
             : number_text(std::fabs(value) < 1e-9 ? 0.0 : value, std::fabs(value) >= 100.0 ? 4 : 3);
}

/// Smallest and largest value of a column among the clean points of a grid: "12 of a grid of 15 clean, least
/// 7/0.1: 0.219, most ...".
std::string grid_figures(const Claim& claim, const Trials& trials, const Lake& lake, const Reading& reading,
                         const std::string& column) {
  std::vector<std::pair<double, std::string>> clean;
  for (std::size_t i = claim.cases.size() - claim.grid_size; i < claim.cases.size(); ++i) {
    const protocol::Json& run = trials.of(settings_of(claim, claim.cases[i], lake, reading));
    const double value = sweep::number_of(run, column);
    if (sweep::number_of(run, "clean") > 0.0 && !std::isnan(value))
      clean.emplace_back(value, claim.cases[i].name);
  }
  if (clean.empty()) return fmt::format("none of a grid of {} clean", claim.grid_size);
  const auto [least, most] = std::minmax_element(clean.begin(), clean.end());
  return fmt::format("{} of a grid of {} clean, least {}: {}, most {}: {}", clean.size(), claim.grid_size,
                     least->second, figure(least->first), most->second, figure(most->first));
}

/// Figures of a claim on one track in one reading: "N25: 50.7, N40: 69.8".
std::string figures_of(const Claim& claim, const Trials& trials, const Lake& lake, const Reading& reading) {
  std::string text;
  for (const std::string& column : claim.shows) {
    text += fmt::format("{}`{}`", text.empty() ? "" : "; ", column);
    for (std::size_t i = 0; i < claim.cases.size() - claim.grid_size; ++i) {
      const sweep::Case& each = claim.cases[i];
      const protocol::Json& run = trials.of(settings_of(claim, each, lake, reading));
      text += fmt::format("{} {}: {}", i == 0 ? "" : ",", each.name, figure(sweep::number_of(run, column)));
    }
    if (claim.grid_size > 0) text += ", " + grid_figures(claim, trials, lake, reading, column);
  }
  return text;
}

/// Cell of the existing page, for a track whose file is missing. `column`: index; 0 is the id.
std::string older_cell(const std::string& page, const std::string& id, int column) {
  const std::size_t row = page.find(fmt::format("\n| {} |", id));
  if (row == std::string::npos) return "";
  std::size_t at = row + 1;
  for (int i = 0; i < column && at != std::string::npos; ++i) at = page.find('|', at + 1);
  const std::size_t end = at == std::string::npos ? at : page.find('|', at + 1);
  return end == std::string::npos || end < at + 3 ? "" : page.substr(at + 2, end - at - 3);
}

/// Statement in our words, with the quotation if there is one.
std::string statement_of(const Claim& claim) {
  return claim.quotes.empty() ? claim.says : fmt::format("{}: “{}”", claim.says, claim.quotes);
}

/// Row of the page: id, statement, verdict, a cell for each track, figures.
std::vector<protocol::Json> row_of(const Claim& claim, const Trials& trials, const std::string& older) {
  if (!claim.is_tried()) return {claim.id, statement_of(claim), claim.found, "", "", "", claim.see};
  const auto& all = lakes();
  std::array<std::string, kLakes> cells;
  for (std::size_t l = 0; l < kLakes; ++l)
    cells[l] = all[l].is_there ? cell_of(marks_of(claim, trials, all[l]))
                               : older_cell(older, claim.id, 3 + static_cast<int>(l));
  return {claim.id,
          statement_of(claim),
          verdict_of(claim, cells[0], cells[1]),
          cells[0],
          cells[1],
          cells[2],
          figures_of(claim, trials, all[0], own_reading(claim))};
}

/// Tables of the page, one for each write-up. `older`: the existing page.
std::string rows_of(const std::vector<Claim>& claims, const Trials& trials, const std::string& older) {
  std::vector<std::string> columns{"", "statement", "verdict"};
  for (const Lake& lake : lakes()) columns.emplace_back(lake.name);
  columns.emplace_back("figures, or where to see");
  std::map<std::string, sweep::ResultTable> tables;
  for (const Claim& claim : claims)
    tables.try_emplace(fmt::format("{}: `{}`", claim.id[0], claim.settings.at(0).second), columns)
        .first->second.add(row_of(claim, trials, older));
  std::string text;
  for (const auto& [group, table] : tables) text += fmt::format("\n## {}\n\n{}", group, table.markdown());
  return text;
}

/// Report on single claims: conditions, figures on each track, and the command of each run.
std::string details_of(const std::vector<Claim>& claims, const Trials& trials) {
  std::string text;
  for (const Claim& claim : claims) {
    text += fmt::format("{}  {}\n", claim.id, statement_of(claim));
    if (!claim.is_tried()) {
      text += fmt::format("    {}: {}\n\n", claim.found, claim.see);
      continue;
    }
    for (const auto& condition : claim.conditions) text += fmt::format("    true when {}\n", condition.text);
    for (const Lake& lake : lakes()) {
      const Marks marks = marks_of(claim, trials, lake);
      for (std::size_t r = 0; r < readings().size(); ++r)
        if (marks[r])
          text += fmt::format("    {:<18} {:<17} {:<4} {}\n", lake.name, readings()[r].name,
                              *marks[r] ? "yes" : "no", figures_of(claim, trials, lake, readings()[r]));
      if (!lake.is_there)
        text += fmt::format("    {:<18} skipped: no {}: tools/fetch_circuits.sh fetches it\n", lake.name,
                            lake.track);
    }
    for (const sweep::Case& each : claim.cases)
      text += fmt::format("    {}: {}\n", each.name,
                          sweep::command_of(settings_of(claim, each, lakes()[0], own_reading(claim))));
    text += '\n';
  }
  return text;
}

constexpr std::string_view kBegin = "<!-- claims: chicane claims -->\n";  // the tables follow it on the page

/// Line of a page that begins with `start`.
std::string line_with(const std::string& page, const std::string& start) {
  const std::size_t row = page.find("\n" + start);
  return row == std::string::npos ? "no such row" : page.substr(row + 1, page.find('\n', row + 1) - row - 1);
}

/// Compares the page with new rows, and prints the differences.
ExitCode compare(const std::string& file, const std::string& older, const std::string& rows,
                 const std::vector<Claim>& claims) {
  int different = 0;
  for (std::size_t at = 0; at < rows.size();) {
    const std::size_t end = rows.find('\n', at);
    const std::string line = rows.substr(at, end - at);
    if (older.find(line + "\n") == std::string::npos) {
      fmt::print("{}: got {}\n{}: expected {}\n", file,
                 line_with(older, line.substr(0, line.find('|', 2) + 1)), file, line);
      ++different;
    }
    at = end + 1;
  }
  const auto quoted =
      std::count_if(claims.begin(), claims.end(), [](const Claim& c) { return !c.quotes.empty(); });
  if (different == 0)
    fmt::print("{}: {} statements as the page has them, {} with a quotation\n", file, claims.size(), quoted);
  return different == 0 ? kSuccess : kRunFailed;
}

}  // namespace

ExitCode try_claims(const Options& options) {
  const std::atomic<bool>& stop = begin_many_runs();
  const auto claims = read_claims(options.claims.folder, options.claims.ids);
  if (!claims) return report(claims.error());
  Trials trials;
  for (const Claim& claim : *claims) {
    for (const sweep::Case& each : claim.cases) {
      for (const Lake& lake : lakes())
        for (const Reading& reading : readings())
          if (lake.takes(claim, reading)) trials.add(settings_of(claim, each, lake, reading));
    }
  }
  for (const Lake& lake : lakes())
    if (!lake.is_there)
      fmt::print(stderr, "skipped: {}: no {}: tools/fetch_circuits.sh fetches it\n", lake.name, lake.track);
  const std::string& page = options.claims.page;
  if (const Result<void> writable = check_writable(options.claims.is_check ? "" : page); !writable)
    return report(writable.error());
  const Result<bool> is_whole = trials.drive(options.jobs, options.results_file, stop);
  if (!is_whole) return report(is_whole.error());
  if (!*is_whole) {
    fmt::print(stderr, "stopped: nothing was compared or written\n");
    return kRunFailed;
  }
  if (page.empty()) {
    fmt::print("{}", details_of(*claims, trials));
    return kSuccess;
  }
  const std::string older = protocol::read_file(page).value_or("");
  const std::string rows = rows_of(*claims, trials, older);
  if (options.claims.is_check) return compare(page, older, rows, *claims);
  if (const Result<void> written = write_below(page, kBegin, rows); !written) return report(written.error());
  fmt::print(stderr, "{}: {} claims\n", page, claims->size());
  return kSuccess;
}

}  // namespace chicane::apps
