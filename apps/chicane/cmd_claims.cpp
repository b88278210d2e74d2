// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>

#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/claim.hpp"
#include "chicane/sweep/sweep.hpp"
#include "chicane/sweep/trial.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

using sweep::Claim;
using sweep::Settings;

constexpr std::string_view kOriginalLake = "../shared/tracks/udacity/lake_scene.csv";

/// How the numbers of a write-up are taken, where it says nothing of telemetry's miles per hour.
struct Reading {
  std::string_view name;
  Settings settings;
};
const std::array<Reading, 3>& readings() {
  static const std::array<Reading, 3> kReadings{
      {{"SI", {{"cubic_mpc.speed_in_mph", "false"}, {"cubic_mpc.roll_forward_in_mph", "false"}}},
       {"mph in the model", {{"cubic_mpc.speed_in_mph", "true"}, {"cubic_mpc.roll_forward_in_mph", "false"}}},
       {"mph throughout", {{"cubic_mpc.speed_in_mph", "true"}, {"cubic_mpc.roll_forward_in_mph", "true"}}}}};
  return kReadings;
}

/// The reading that the claim's preset has.
const Reading& own_reading(const Claim& claim) {
  const auto request = sweep::request_of(claim.settings);
  const auto scenario = request ? protocol::compose(*request) : fail(request.error());
  const auto is_set = [&](const char* key) {
    return scenario && protocol::get_text(*scenario, *protocol::find(key)) == "true";
  };
  const bool is_throughout = is_set("cubic_mpc.roll_forward_in_mph");
  return readings()[is_throughout ? 2 : is_set("cubic_mpc.speed_in_mph") ? 1 : 0];
}

struct Lake {
  std::string_view name;
  std::string track;
  bool is_there = true;
};
std::vector<Lake> lakes() {
  std::error_code error;
  return {{"lakeside", "lakeside"},
          {"the original lake", std::string(kOriginalLake), std::filesystem::exists(kOriginalLake, error)}};
}

/// All claims of the folder, by file and place.
Result<std::vector<Claim>> read_claims(const std::string& folder, const std::vector<std::string>& wanted) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  if (files.empty())
    return fail(ErrorCode::kNotFound,
                fmt::format("{}: got no claims, expected a folder with *.yaml", folder));
  std::sort(files.begin(), files.end());
  std::vector<Claim> claims;
  for (const std::string& file : files) {
    const Result<std::string> text = protocol::read_file(file);
    if (!text) return fail(text.error());
    Result<std::vector<Claim>> read = sweep::parse_claims(*text, file);
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

/// Settings of one case in one world. The claim's own win over the reading's.
Settings settings_of(const Claim& claim, const sweep::Case& each, const Lake& lake, const Reading& reading) {
  Settings settings{{"guard.mode", "off"}, {"laps", "3"}, {"time_limit_s", "400"}, {"track", lake.track}};
  settings.insert(settings.end(), reading.settings.begin(), reading.settings.end());
  settings.insert(settings.end(), claim.settings.begin(), claim.settings.end());
  settings.insert(settings.end(), each.settings.begin(), each.settings.end());
  return settings;
}

/// Results of runs by their commands: many claims have the same.
class Trials {
 public:
  void add(const Settings& settings) { wanted_.emplace(sweep::command_of(settings), settings); }

  Result<void> drive(int jobs, const std::atomic<bool>& stop) {
    const std::vector<std::pair<std::string, Settings>> all(wanted_.begin(), wanted_.end());
    std::mutex mutex;
    std::optional<Error> failure;
    RunCounter counter;
    run::for_each_run(all.size(), jobs, [&](std::uint64_t i, run::Roads& roads) {
      auto run = sweep::drive(all[i].second, roads, stop);
      const std::lock_guard lock(mutex);
      if (!run) failure = Error{run.error().code, all[i].first + ": " + run.error().message};
      if (run && *run) results_[all[i].first] = std::move(**run);
      counter.show(results_.size(), all.size(), results_.size());
      return !stop && !failure;
    });
    counter.end();
    if (failure) return fail(*failure);
    return {};
  }

  [[nodiscard]] const telemetry::RunSummary& of(const Settings& settings) const {
    return results_.at(sweep::command_of(settings));
  }

 private:
  std::map<std::string, Settings> wanted_;
  std::map<std::string, telemetry::RunSummary> results_;
};

/// Whether a claim holds, by lake and reading; none where the lake is not there.
using Marks = std::array<std::array<std::optional<bool>, 3>, 2>;

Marks marks_of(const Claim& claim, const Trials& trials) {
  Marks marks;
  const std::vector<Lake> all = lakes();
  for (std::size_t l = 0; l < all.size(); ++l) {
    for (std::size_t r = 0; r < readings().size() && all[l].is_there; ++r) {
      sweep::CaseResults results;
      for (const sweep::Case& each : claim.cases)
        results[each.name] = trials.of(settings_of(claim, each, all[l], readings()[r]));
      marks[l][r] = sweep::holds(claim, results);
    }
  }
  return marks;
}

std::string cell_of(const std::array<std::optional<bool>, 3>& marks) {
  if (!marks[0]) return "";
  std::string cell;
  for (const auto& mark : marks) cell += fmt::format("{}{}", cell.empty() ? "" : " · ", *mark ? "yes" : "no");
  return cell;
}

/// true, false, or on what it depends.
std::string verdict_of(const std::string& lakeside, const std::string& original) {
  const std::string all = lakeside + original;
  if (all.find("no") == std::string::npos) return "**true**";
  if (all.find("yes") == std::string::npos) return "**false**";
  if (original.empty() || lakeside == original) return "depends on the reading of speed";
  const auto is_even = [](const std::string& cell) {
    return cell.find("yes") == std::string::npos || cell.find("no") == std::string::npos;
  };
  return is_even(lakeside) && is_even(original) ? "depends on the lake" : "depends on lake and reading";
}

std::string figure(double value) {
  return std::isnan(value)
             ? "–"
             : number_text(std::fabs(value) < 1e-9 ? 0.0 : value, std::fabs(value) >= 100.0 ? 4 : 3);
}

/// "N25 50.7, N40 69.8" in one world.
std::string figures_of(const Claim& claim, const Trials& trials, const Lake& lake, const Reading& reading) {
  std::string text;
  for (const std::string& column : claim.shows) {
    text += fmt::format("{}`{}`", text.empty() ? "" : "; ", column);
    for (std::size_t i = 0; i < claim.cases.size(); ++i) {
      const sweep::Case& each = claim.cases[i];
      const auto& run = trials.of(settings_of(claim, each, lake, reading));
      text += fmt::format("{} {}: {}", i == 0 ? "" : ",", each.name, figure(sweep::number_of(run, column)));
    }
  }
  return text;
}

/// The cell of an older page, for a lake that is not there.
std::string older_cell(const std::string& page, const std::string& id, int column) {
  const std::size_t row = page.find(fmt::format("| {} |", id));
  std::size_t at = row;
  for (int i = 0; i < column && at != std::string::npos; ++i) at = page.find('|', at + 1);
  if (row == std::string::npos || at == std::string::npos) return "";
  const std::size_t end = page.find('|', at + 1);
  return end == std::string::npos ? "" : page.substr(at + 2, end - at - 3);
}

/// The rows of the page: id, statement, verdict, lakeside, original lake, figures.
std::string rows_of(const std::vector<Claim>& claims, const Trials& trials, const std::string& older) {
  const std::vector<Lake> all = lakes();
  std::string text;
  char group = 0;
  for (const Claim& claim : claims) {
    if (claim.id[0] != group) {
      group = claim.id[0];
      text += fmt::format(
          "\n## Write-up {}\n\n| | statement | verdict | lakeside | original lake | figures, or where to see "
          "|\n"
          "|---|---|---|---|---|---|\n",
          group);
    }
    if (!claim.is_tried()) {
      text += fmt::format("| {} | {} | {} | | | {} |\n", claim.id, claim.says, claim.found, claim.see);
      continue;
    }
    const Marks marks = marks_of(claim, trials);
    const std::string lakeside = cell_of(marks[0]);
    const std::string original = all[1].is_there ? cell_of(marks[1]) : older_cell(older, claim.id, 5);
    text +=
        fmt::format("| {} | {} | {} | {} | {} | {} |\n", claim.id, claim.says, verdict_of(lakeside, original),
                    lakeside, original, figures_of(claim, trials, all[0], own_reading(claim)));
  }
  return text;
}

/// Everything about a few claims: conditions, figures of every world, and the command of every run.
std::string details_of(const std::vector<Claim>& claims, const Trials& trials) {
  std::string text;
  for (const Claim& claim : claims) {
    text += fmt::format("{}  {}\n", claim.id, claim.says);
    if (!claim.is_tried()) {
      text += fmt::format("    {}: {}\n\n", claim.found, claim.see);
      continue;
    }
    for (const auto& condition : claim.conditions) text += fmt::format("    true when {}\n", condition.text);
    const Marks marks = marks_of(claim, trials);
    const std::vector<Lake> all = lakes();
    for (std::size_t l = 0; l < all.size(); ++l) {
      for (std::size_t r = 0; r < readings().size() && all[l].is_there; ++r)
        text += fmt::format("    {:<18} {:<17} {:<4} {}\n", all[l].name, readings()[r].name,
                            *marks[l][r] ? "yes" : "no", figures_of(claim, trials, all[l], readings()[r]));
      if (!all[l].is_there) text += fmt::format("    {} is not there: {}\n", all[l].name, all[l].track);
    }
    for (const sweep::Case& each : claim.cases)
      text += fmt::format("    {}: {}\n", each.name,
                          sweep::command_of(settings_of(claim, each, all[0], own_reading(claim))));
    text += '\n';
  }
  return text;
}

constexpr std::string_view kBegin = "<!-- claims: chicane claims -->\n";

std::string page_of(const std::string& older, const std::string& rows) {
  const std::size_t begin = older.find(kBegin);
  return begin == std::string::npos ? fmt::format("{}{}", kBegin, rows)
                                    : older.substr(0, begin + kBegin.size()) + rows;
}

ExitCode compare(const std::string& file, const std::string& older, const std::string& rows) {
  int different = 0;
  for (std::size_t at = 0; at < rows.size();) {
    const std::size_t end = rows.find('\n', at);
    const std::string line = rows.substr(at, end - at);
    if (older.find(line + "\n") == std::string::npos) {
      fmt::print("{}: not there: {}\n", file, line);
      ++different;
    }
    at = end + 1;
  }
  return different == 0 ? kSuccess : kRunFailed;
}

}  // namespace

ExitCode try_claims(const Options& options) {
  keep_memory();
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  const auto claims = read_claims(options.claims.folder, options.claims.ids);
  if (!claims) return report(claims.error());
  const std::vector<Lake> all = lakes();
  Trials trials;
  for (const Claim& claim : *claims) {
    for (const sweep::Case& each : claim.cases) {
      for (const Lake& lake : all)
        for (const Reading& reading : readings())
          if (lake.is_there) trials.add(settings_of(claim, each, lake, reading));
    }
  }
  if (!all[1].is_there) fmt::print(stderr, "{} is not there: tried on lakeside alone\n", all[1].track);
  const std::string& page = options.claims.page;
  if (const Result<void> writable = check_writable(options.claims.is_check ? "" : page); !writable)
    return report(writable.error());
  if (const Result<void> driven = trials.drive(run::threads_for(options.jobs), stop); !driven)
    return report(driven.error());
  if (stop) {
    fmt::print(stderr, "stopped: nothing was compared or written\n");
    return kRunFailed;
  }
  if (page.empty()) {
    fmt::print("{}", details_of(*claims, trials));
    return kSuccess;
  }
  const std::string older = protocol::read_file(page).value_or("");
  const std::string rows = rows_of(*claims, trials, older);
  if (options.claims.is_check) return compare(page, older, rows);
  std::ofstream out(page, std::ios::trunc);
  out << page_of(older, rows);
  out.close();
  if (!out) return report(Error{ErrorCode::kIo, page + ": cannot be written"});
  fmt::print(stderr, "{}: {} claims\n", page, claims->size());
  return kSuccess;
}

}  // namespace chicane::apps
