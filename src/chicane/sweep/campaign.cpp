// SPDX-License-Identifier: MIT
#include "chicane/sweep/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "chicane/base/random.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "chicane/sweep/detail/settings_reader.hpp"
#include "chicane/sweep/detail/text_hash.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

constexpr std::size_t kBatch = 96;  ///< trials that share what comes before their faults, at least
constexpr const char* kOwn = "own";
constexpr const char* kLasts = "inf";

Axis axis_of(const char* key, std::vector<std::string> list) {
  Axis axis;
  axis.size = list.size();
  axis.dimensions.push_back({.key = key, .list = std::move(list)});
  return axis;
}

std::vector<std::string> faults_of(const Campaign& campaign) {
  std::vector<std::string> names = campaign.faults;
  const std::size_t singles = names.size();
  for (std::size_t i = 0; campaign.has_pairs && i < singles; ++i)
    for (std::size_t j = i + 1; j < singles; ++j) names.push_back(names[i] + "+" + names[j]);
  return names;
}

std::string duration_text(double duration) {
  return duration >= run::kLasting ? std::string(kLasts) : number_text(duration);
}

/// The one or two faults of a group; kInvalidArgument for a name that is none.
Result<std::vector<sim::Fault>> parts_of(const std::string& names) {
  std::vector<sim::Fault> parts;
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find('+', begin), names.size());
    const auto fault = sim::fault_named(std::string_view(names).substr(begin, end - begin));
    if (!fault) return fail(ErrorCode::kInvalidArgument, fmt::format("no such fault: {}", printable(names)));
    parts.push_back(*fault);
    begin = end + 1;
  }
  return parts;
}

/// Duration of the axis for_s [s]; "own": the longest that one of the faults has.
double duration_of(const CampaignGroup& group, const std::vector<sim::Fault>& parts) {
  if (group.lasts == kLasts) return run::kLasting;
  if (group.lasts != kOwn) return detail::number_in(group.lasts).value_or(0.0);
  double longest = 0.0;
  for (const sim::Fault fault : parts) longest = std::max(longest, sim::kind_of(fault).duration);
  return longest;
}

/// The moments of one group depend on its names and the seed alone.
std::vector<double> onsets_of(const Campaign& campaign, const CampaignGroup& group, double lap_time) {
  std::vector<double> onsets;
  if (campaign.onsets == 0) {
    for (int i = 0; i * campaign.step < lap_time; ++i) onsets.push_back(i * campaign.step);
    return onsets;
  }
  Fnv hash;
  hash.add(campaign.seed);
  for (const std::string* text : {&group.track, &group.car, &group.preset, &group.fault, &group.lasts})
    detail::add_text(hash, *text);
  Random random{hash.value()};
  for (int i = 0; i < campaign.onsets; ++i) onsets.push_back(random.uniform(0.0, lap_time));
  return onsets;
}

CampaignGroup group_at(const Plan& plan, std::uint64_t run) {
  const Settings at = plan.at(run);
  return {.track = at[0].second,
          .car = at[1].second,
          .preset = at[2].second,
          .fault = at[3].second,
          .lasts = at[4].second};
}

bool is_same_place(const CampaignGroup& a, const CampaignGroup& b) {
  return a.track == b.track && a.car == b.car && a.preset == b.preset;
}

/// Where the trials of one car and preset on one track are driven.
struct Place {
  scenario::Scenario scenario;
  run::FlyingLap lap;
};

Result<Place> place_of(const Campaign& campaign, const CampaignGroup& group) {
  protocol::Request request;
  request.settings = {{"preset", group.preset}};
  request.settings.insert(request.settings.end(), campaign.settings.begin(), campaign.settings.end());
  request.settings.emplace_back("track", group.track);
  request.settings.emplace_back("car", group.car);
  Result<scenario::Scenario> scenario = protocol::compose(request);
  if (!scenario) return fail(scenario.error());
  double wait = run::kLongestWait;
  for (const double duration : campaign.durations) wait = std::max(wait, run::longest_trial(duration));
  Result<run::FlyingLap> lap = run::drive_undisturbed(*scenario, wait);
  if (!lap) return fail(lap.error());
  return Place{std::move(*scenario), std::move(*lap)};
}

std::string line_of(std::uint64_t run, const CampaignGroup& group) {
  const Json settings{{"track", group.track},
                      {"car", group.car},
                      {"preset", group.preset},
                      {"fault", group.fault},
                      {"for_s", group.lasts}};
  Json trials = Json::array();
  for (const CampaignTrial& trial : group.trials)
    trials.push_back({{"at_s", trial.at},
                      {"until_s", trial.until},
                      {"for_s", duration_text(trial.duration)},
                      {"least_edge_m", trial.least_edge},
                      {"off_anyway", trial.is_off_anyway},
                      {"stands", trial.stands},
                      {"not_controller", trial.replaced}});
  const Json rest = group.error.empty() ? Json{{"trials", trials}} : Json{{"error", group.error}};
  return fmt::format("{{\"run\":{},\"settings\":{},{}", run, protocol::json_text(settings),
                     protocol::json_text(rest).substr(1));
}

/// Drives one campaign into its file.
class Driver {
 public:
  Driver(const Campaign& campaign, const CampaignOptions& options, ResultFile& file, const Plan& plan,
         const std::atomic<bool>& stop)
      : campaign_{campaign}, options_{options}, file_{file}, plan_{plan}, stop_{stop} {
    progress_ = {.runs = plan.size(), .found = file.done()};
  }

  Result<Progress> drive() {
    for (std::uint64_t run = 0; run < plan_.size() && !stop_; ++run) {
      if (file_.has(run)) continue;
      CampaignGroup group = group_at(plan_, run);
      if (!place_ || !is_same_place(group, at_)) {
        if (Result<void> done = drive_batch(); !done) return fail(done.error());
        if (stop_) break;
        at_ = group;
        place_ = place_of(campaign_, group);
      }
      Result<void> done = add(run, std::move(group));
      if (done && trials_.size() >= kBatch) done = drive_batch();
      if (!done) return fail(done.error());
    }
    if (Result<void> done = drive_batch(); !done) return fail(done.error());
    return progress_;
  }

 private:
  struct Waiting {
    std::uint64_t run;
    CampaignGroup group;
    std::size_t trials;
  };

  /// A group whose trials are driven with the next batch.
  Result<void> add(std::uint64_t run, CampaignGroup group) {
    const auto parts = parts_of(group.fault);
    if (!*place_ || !parts) {
      group.error = (*place_ ? parts.error() : place_->error()).message;
      if (progress_.failed++ == 0) progress_.why = group.error;
      waiting_.push_back({run, std::move(group), 0});
      return {};
    }
    const std::vector<double> onsets = onsets_of(campaign_, group, (*place_)->lap.time);
    for (const double onset : onsets) {
      run::FaultTrial trial{.fault = parts->front(),
                            .onset = onset,
                            .duration = duration_of(group, *parts),
                            .strength = sim::kind_of(parts->front()).strength};
      if (parts->size() > 1) trial.second = parts->at(1);
      trials_.push_back(trial);
    }
    waiting_.push_back({run, std::move(group), onsets.size()});
    return {};
  }

  /// Drives what waits and writes the groups that are complete, in the order of the plan.
  Result<void> drive_batch() {
    std::vector<run::FaultOutcome> outcomes;
    if (!trials_.empty() && !stop_) {
      const auto goes_on = [&](std::size_t) { return !stop_.load(); };
      auto driven = run::drive_trials((*place_)->scenario, (*place_)->lap, trials_, options_.jobs, goes_on);
      if (!driven) return fail(driven.error());
      outcomes = std::move(*driven);
    }
    outcomes.resize(trials_.size());
    trials_.clear();
    auto next = outcomes.cbegin();
    for (Waiting& each : std::exchange(waiting_, {})) {
      const auto begin = std::exchange(next, next + static_cast<std::ptrdiff_t>(each.trials));
      const bool is_whole =
          std::all_of(begin, next, [](const auto& outcome) { return std::isfinite(outcome.least_edge); });
      if (!is_whole) return {};
      std::transform(begin, next, std::back_inserter(each.group.trials),
                     [&](const auto& outcome) { return trial_of(outcome); });
      if (Result<void> done = file_.append(line_of(each.run, each.group)); !done) return done;
      ++progress_.driven;
      if (options_.on_progress) options_.on_progress(progress_);
    }
    return {};
  }

  CampaignTrial trial_of(const run::FaultOutcome& outcome) const {
    return {
        .at = outcome.at,
        .until = outcome.until,
        .duration = outcome.trial.duration,
        .least_edge = outcome.least_edge,
        .is_off_anyway = outcome.has_left_road() && (*place_)->lap.is_off_within(outcome.at, outcome.until),
        .stands = outcome.stands(),
        .replaced = outcome.not_controller};
  }

  const Campaign& campaign_;
  const CampaignOptions& options_;
  ResultFile& file_;
  const Plan& plan_;
  const std::atomic<bool>& stop_;
  CampaignGroup at_;                    ///< any group of the place
  std::optional<Result<Place>> place_;  ///< of what waits
  std::vector<Waiting> waiting_;
  std::vector<run::FaultTrial> trials_;  ///< of all that waits
  Progress progress_;
};

CampaignTrial trial_in(const Json& json) {
  const std::string lasts = json.at("for_s");
  return {.at = json.at("at_s"),
          .until = json.at("until_s"),
          .duration = lasts == kLasts ? run::kLasting : detail::number_in(lasts).value_or(0.0),
          .least_edge = json.at("least_edge_m"),
          .is_off_anyway = json.at("off_anyway"),
          .stands = json.at("stands"),
          .replaced = json.at("not_controller")};
}

CampaignGroup group_in(const Json& json) {
  const Json& settings = json.at("settings");
  CampaignGroup group{.track = settings.at("track"),
                      .car = settings.at("car"),
                      .preset = settings.at("preset"),
                      .fault = settings.at("fault"),
                      .lasts = settings.at("for_s"),
                      .error = json.value("error", "")};
  for (const Json& trial : json.value("trials", Json::array())) group.trials.push_back(trial_in(trial));
  return group;
}

}  // namespace

std::vector<std::string> signal_faults() {
  std::vector<std::string> names;
  for (const sim::FaultKind& kind : sim::fault_kinds())
    if (kind.actuate == nullptr && kind.grip == nullptr && kind.side_acceleration == nullptr)
      names.emplace_back(kind.name);
  return names;
}

Plan plan_of(const Campaign& campaign) {
  Plan plan{.name = "campaign", .fixed = campaign.settings, .keep = {"trials"}};
  if (campaign.onsets > 0) {
    plan.fixed.emplace_back("onsets", std::to_string(campaign.onsets));
    plan.fixed.emplace_back("onset_seed", std::to_string(campaign.seed));
  } else {
    plan.fixed.emplace_back("every_s", number_text(campaign.step));
  }
  std::vector<std::string> durations;
  for (const double duration : campaign.durations) durations.push_back(duration_text(duration));
  if (durations.empty()) durations = {kOwn};
  plan.axes = {axis_of("track", campaign.tracks), axis_of("car", campaign.cars),
               axis_of("preset", campaign.presets), axis_of("fault", faults_of(campaign)),
               axis_of("for_s", durations)};
  return plan;
}

Settings settings_of(const Settings& fixed, const CampaignGroup& group, const CampaignTrial& trial) {
  Settings settings{{"preset", group.preset}};
  settings.insert(settings.end(), fixed.begin(), fixed.end());
  settings.insert(settings.end(), {{"track", group.track},
                                   {"car", group.car},
                                   {"laps", "0"},
                                   {"time_limit_s", number_text(trial.until, 9)}});
  const auto parts = parts_of(group.fault);
  for (const sim::Fault fault : parts ? *parts : std::vector<sim::Fault>{})
    settings.emplace_back("fault", fmt::format("{}@{}+{}", sim::kind_of(fault).name, number_text(trial.at),
                                               number_text(trial.duration)));
  return settings;
}

Result<Progress> drive_campaign(const Campaign& campaign, const CampaignOptions& options,
                                const std::atomic<bool>& stop) {
  const Plan plan = plan_of(campaign);
  Result<ResultFile> file = ResultFile::open(options.file, plan, {});
  if (!file) return fail(file.error());
  return Driver(campaign, options, *file, plan, stop).drive();
}

Result<std::vector<CampaignGroup>> read_campaign(const std::string& file) {
  std::vector<CampaignGroup> groups;
  const auto read = read_lines(file, [&](const LinePlace&, const std::string& line) -> Result<void> {
    try {
      groups.push_back(group_in(protocol::parse_json(line)));
    } catch (const Json::exception&) {
      return fail(ErrorCode::kParse, fmt::format("got {}, expected a group of trials", printable(line)));
    }
    return {};
  });
  if (!read) return fail(read.error());
  return groups;
}

}  // namespace chicane::sweep
