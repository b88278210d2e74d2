// SPDX-License-Identifier: MIT
// `chicane campaign`: drives faults, alone and in pairs, at moments of a flying lap, and counts how often the
// car leaves the road.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/campaign.hpp"
#include "chicane/sweep/trial.hpp"
#include "commands.hpp"
#include "lab/many_runs.hpp"

namespace chicane::apps {
namespace {

using sweep::CampaignGroup;
using sweep::CampaignTrial;

/// Row of the table: all trials of one fault or pair and one duration, with one car and preset, on all
/// tracks.
struct Row {
  std::string car{}, preset{}, fault{}, lasts{};  ///< fields of CampaignGroup
  std::int64_t trials = 0, off = 0;        ///< numbers of trials, and of those off the road by the fault
  std::int64_t off_anyway = 0;             ///< trials off the road also without the fault
  std::int64_t lasting = 0, standing = 0;  ///< trials with a lasting fault, and cars that stand in the end
  double least_edge = std::numeric_limits<double>::infinity();  ///< gap to the edge in the worst trial [m]
  double duration = 0.0;                                        ///< duration of the faults [s]
  std::string worst{};                                          ///< command of the worst trial
  bool is_worst_anyway = false;  ///< the worst trial is off the road also without the fault

  [[nodiscard]] auto key() const { return std::tie(car, preset, fault, lasts); }

  /// Counts a trial. The worst one has the least gap; a trial off the road by the fault is worse than one
  /// that is off the road anyway.
  void add(const CampaignTrial& trial, const std::string& command) {
    ++trials;
    duration = trial.duration;
    if (trial.least_edge < 0.0) ++(trial.is_off_anyway ? off_anyway : off);
    if (trial.duration >= run::kLasting) {
      ++lasting;
      if (trial.stands) ++standing;
    }
    const bool is_first_by_fault = is_worst_anyway && trial.least_edge < 0.0 && !trial.is_off_anyway;
    const bool is_hidden = trial.is_off_anyway && off > 0;
    if (!is_hidden && (is_first_by_fault || trial.least_edge < least_edge)) {
      least_edge = trial.least_edge;
      worst = command;
      is_worst_anyway = trial.is_off_anyway;
    }
  }
  /// Cell of the column "standing".
  [[nodiscard]] std::string standing_text() const {
    return lasting == 0 ? std::string("–") : fmt::format("{} of {}", standing, lasting);
  }
  [[nodiscard]] std::string name() const { return fmt::format("{} {} {} {}", car, preset, fault, words()); }
  [[nodiscard]] bool is_lasting() const { return duration >= run::kLasting; }
  /// Duration in words.
  [[nodiscard]] std::string words() const {
    return is_lasting() ? std::string("lasting") : number_text(duration) + " s";
  }
};

/// Rows of all groups, in the order of the groups.
std::vector<Row> rows_of(const std::vector<CampaignGroup>& groups, const sweep::Settings& settings) {
  std::vector<Row> rows;
  for (const CampaignGroup& group : groups) {
    if (group.trials.empty()) continue;
    const Row key{group.car, group.preset, group.fault, group.lasts};
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.key() == key.key(); });
    const auto place = static_cast<std::size_t>(found - rows.begin());
    if (found == rows.end()) rows.push_back(key);
    for (const CampaignTrial& trial : group.trials)
      rows[place].add(trial, sweep::command_of(sweep::settings_of(settings, group, trial)));
  }
  return rows;
}

/// Table of the rows.
sweep::ResultTable table_of(const std::vector<Row>& rows) {
  using protocol::Json;
  sweep::ResultTable table({"car=car", "preset=preset", "fault=fault", "for{>}", "for_s=", "trials=trials{>}",
                            "off_road=off{>}", "off_road_anyway=anyway{>}", "standing{>}",
                            "standing=", "least_edge_m=edge [m]{>.2}", "worst="});
  for (const Row& row : rows)
    table.add({row.car, row.preset, row.fault, row.words(), row.is_lasting() ? Json() : Json(row.duration),
               row.trials, row.off, row.off_anyway, row.standing_text(),
               row.lasting == 0 ? Json() : Json(row.standing), row.least_edge, row.worst});
  return table;
}

/// Prints the command of the worst trial of each row with a car off the road.
void print_worst(const std::vector<Row>& rows, const char* indent) {
  for (const Row& row : rows)
    if (row.off + row.off_anyway > 0)
      fmt::print("\n{}: off the road {} of {} times{}; the worst:{}{}\n", row.name(), row.off, row.trials,
                 row.off_anyway > 0 ? fmt::format(", {} more also without the fault", row.off_anyway) : "",
                 indent, row.worst);
}

/// The names; for "all" those of the whole shelf. Fails as protocol::locate() does.
Result<std::vector<std::string>> names_on(protocol::Shelf shelf, const std::vector<std::string>& names) {
  std::vector<std::string> all;
  if (names != std::vector<std::string>{"all"}) {
    for (const std::string& name : names)
      if (const auto file = protocol::locate(shelf, name); !file) return fail(file.error());
    return names;
  }
  for (const protocol::Entry& entry : protocol::entries(shelf)) all.push_back(entry.name);
  return all;
}

/// Faults of --faults, or the default.
Result<std::vector<std::string>> chosen_faults(const Options::Campaign& campaign) {
  std::vector<std::string> names = campaign.faults;
  if (names.empty() && campaign.has_pairs) return sweep::signal_faults();
  if (names.empty())
    for (const sim::FaultKind& kind : sim::fault_kinds()) names.emplace_back(kind.name);
  for (const std::string& name : names) {
    if (!sim::fault_named(name)) return fail(refusal("--faults", name, protocol::expected_fault(name)));
  }
  return names;
}

/// Campaign of the command line.
Result<sweep::Campaign> campaign_of(const Options& options) {
  const Options::Campaign& asked = options.campaign;
  Result<std::vector<std::string>> faults = chosen_faults(asked);
  Result<std::vector<std::string>> tracks = names_on(protocol::Shelf::kTrack, asked.tracks);
  Result<std::vector<std::string>> cars = names_on(protocol::Shelf::kCar, asked.cars);
  Result<std::vector<std::string>> presets = names_on(protocol::Shelf::kPreset, asked.presets);
  for (const auto* const names : {&faults, &tracks, &cars, &presets})
    if (!*names) return fail(names->error());
  return sweep::Campaign{.tracks = std::move(*tracks),
                         .cars = std::move(*cars),
                         .presets = std::move(*presets),
                         .faults = std::move(*faults),
                         .has_pairs = asked.has_pairs,
                         .durations = asked.durations,
                         .onsets = asked.onsets,
                         .seed = asked.seed,
                         .step = asked.step,
                         .settings = options.settings};
}

/// Prints on stderr why groups could not be driven, each reason once.
void print_errors(const std::vector<CampaignGroup>& groups) {
  std::vector<std::string> reported;
  for (const CampaignGroup& group : groups) {
    if (group.error.empty() || std::find(reported.begin(), reported.end(), group.error) != reported.end())
      continue;
    reported.push_back(group.error);
    fmt::print(stderr, "not tried: {}\n", group.error);
  }
}

}  // namespace

ExitCode campaign(const Options& options) {
  const std::atomic<bool>& wants_stop = begin_many_runs();
  const Result<sweep::Campaign> campaign = campaign_of(options);
  if (!campaign) return report(campaign.error());
  const int jobs = run::threads_for(options.jobs);
  const PlanRuns runs{.plan = sweep::plan_of(*campaign),
                      .rule = sweep::rule_of(*campaign, jobs, wants_stop),
                      .what = "groups of trials",
                      .keeps_failed = true};
  const Result<RunLines> driven = drive_runs(runs, 1, options.results_file, wants_stop);
  if (!driven) return report(driven.error());
  std::vector<CampaignGroup> groups;
  for (const auto& [run, line] : driven->lines) {
    Result<CampaignGroup> group = sweep::group_of(line);
    if (!group) return report(group.error());
    groups.push_back(std::move(*group));
  }
  const std::vector<Row> rows = rows_of(groups, campaign->settings);
  print_table(options, table_of(rows));
  if (!options.is_json) print_worst(rows, options.is_markdown ? "\n\n    " : "\n  ");
  print_errors(groups);
  const bool is_kept =
      std::none_of(rows.begin(), rows.end(), [](const Row& row) { return row.off + row.off_anyway > 0; });
  const bool are_tried = driven->progress.is_complete() &&
                         std::all_of(groups.begin(), groups.end(),
                                     [](const CampaignGroup& group) { return group.error.empty(); });
  return is_kept && are_tried ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
