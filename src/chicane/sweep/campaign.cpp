// SPDX-License-Identifier: MIT
// Campaigns of faults: groups of trials as runs of a plan.
#include "chicane/sweep/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "chicane/base/random.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

constexpr std::size_t kBatch = 96;          // least trials that share the laps before their faults; chosen
constexpr const char* kDuration = "for_s";  // key of a duration as text, because it may be "inf" or "own"
constexpr const char* kOwn = "own";         // value of for_s: duration of the fault's own kind
constexpr const char* kLasts = "inf";       // value of for_s: to the end of the trial

/// Values of the axis of faults: single names, then all pairs "a+b" if the campaign has pairs.
std::vector<std::string> faults_of(const Campaign& campaign) {
  std::vector<std::string> names = campaign.faults;
  const std::size_t singles = names.size();
  for (std::size_t i = 0; campaign.has_pairs && i < singles; ++i)
    for (std::size_t j = i + 1; j < singles; ++j) names.push_back(names[i] + "+" + names[j]);
  return names;
}

/// Duration as a value of for_s.
std::string duration_text(double duration) {
  return duration >= run::kLasting ? std::string(kLasts) : number_text(duration);
}

/// Faults of a group's name, "a" or "a+b". Fails with kInvalidArgument for an unknown fault.
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

/// Duration of a group's faults [s]; for "own" the longest own duration of its faults.
double duration_of(const CampaignGroup& group, const std::vector<sim::Fault>& parts) {
  if (group.lasts == kLasts) return run::kLasting;
  if (group.lasts != kOwn) return number_in(group.lasts).value_or(0.0);
  double longest = 0.0;
  for (const sim::Fault fault : parts) longest = std::max(longest, sim::kind_of(fault).duration);
  return longest;
}

/// Starts of the faults of a group [s], counted from the start of the flying lap: a function of the group's
/// names and the seed alone.
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

/// Group of a run of the plan, without trials.
CampaignGroup group_at(const Plan& plan, std::uint64_t run) {
  const Settings at = plan.at(run);
  return {.track = at[0].second,
          .car = at[1].second,
          .preset = at[2].second,
          .fault = at[3].second,
          .lasts = at[4].second};
}

/// Whether two groups share the laps before their faults.
bool is_same_place(const CampaignGroup& a, const CampaignGroup& b) {
  return a.track == b.track && a.car == b.car && a.preset == b.preset;
}

/// Scenario of one car and preset on one track, and its flying lap without faults.
struct Place {
  scenario::Scenario scenario;
  run::FlyingLap lap;
};

/// Place of a group; drives the laps before the faults.
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

/// Trials of a group as JSON, for its line in the file.
std::string text_of(const std::vector<CampaignTrial>& trials) {
  Json all = Json::array();
  for (const CampaignTrial& trial : trials) {
    Json& json = all.emplace_back(Json::object());
    CampaignTrial::rows(trial, [&](const char* name, auto value) { json[name] = value; });
    json[kDuration] = duration_text(trial.duration);
  }
  return protocol::json_text(Json{{"trials", std::move(all)}});
}

/// Driver of groups of trials. It drives a group together with the groups of the same place that follow, and
/// keeps their results until they are asked for.
class Driver {
 public:
  Driver(const Campaign& campaign, int jobs, const std::atomic<bool>& stop)
      : campaign_{campaign}, plan_{plan_of(campaign)}, jobs_{jobs}, stop_{stop} {}

  /// Trials of the group of run `run` as JSON; empty if the campaign was stopped.
  Result<std::optional<std::string>> drive(std::uint64_t run) {
    const CampaignGroup group = group_at(plan_, run);
    if (!place_ || !is_same_place(group, at_)) {
      at_ = group;
      place_ = place_of(campaign_, group);
      ready_.clear();
    }
    if (!*place_) return fail(place_->error());
    if (const auto parts = parts_of(group.fault); !parts) return fail(parts.error());
    if (ready_.count(run) == 0) {
      if (Result<void> done = drive_from(run); !done) return fail(done.error());
    }
    const auto found = ready_.find(run);
    if (found == ready_.end()) return std::optional<std::string>{};
    return std::optional(std::move(ready_.extract(found).mapped()));
  }

 private:
  /// Drives the group of run `first`, and groups after it until there are kBatch trials.
  Result<void> drive_from(std::uint64_t first) {
    std::vector<run::FaultTrial> trials;
    std::vector<std::size_t> ends;  // end of each group in `trials`
    for (std::uint64_t run = first; run < plan_.size() && trials.size() < kBatch; ++run) {
      const CampaignGroup group = group_at(plan_, run);
      if (!is_same_place(group, at_)) break;
      add_trials(group, trials);
      ends.push_back(trials.size());
    }
    const auto goes_on = [&](std::size_t) { return !stop_.load(); };
    const auto driven = run::drive_trials((*place_)->scenario, (*place_)->lap, trials, jobs_, goes_on);
    if (!driven) return fail(driven.error());
    std::size_t next = 0;
    for (std::size_t i = 0; i < ends.size() && !stop_; ++i) {
      std::vector<CampaignTrial> of_group;
      for (; next < ends[i]; ++next) of_group.push_back(trial_of((*driven)[next]));
      ready_[first + i] = text_of(of_group);
    }
    return {};
  }

  /// Adds the trials of a group; none for an unknown fault.
  void add_trials(const CampaignGroup& group, std::vector<run::FaultTrial>& trials) const {
    const auto parts = parts_of(group.fault);
    if (!parts) return;
    for (const double onset : onsets_of(campaign_, group, (*place_)->lap.time)) {
      run::FaultTrial trial{.fault = parts->front(),
                            .onset = onset,
                            .duration = duration_of(group, *parts),
                            .strength = sim::kind_of(parts->front()).strength};
      if (parts->size() > 1) trial.second = parts->at(1);
      trials.push_back(trial);
    }
  }

  /// Result of a trial.
  [[nodiscard]] CampaignTrial trial_of(const run::FaultOutcome& outcome) const {
    return {
        .at = outcome.at,
        .until = outcome.until,
        .duration = outcome.trial.duration,
        .least_edge = outcome.least_edge,
        .is_off_anyway = outcome.has_left_road() && (*place_)->lap.is_off_within(outcome.at, outcome.until),
        .stands = outcome.stands(),
        .replaced = outcome.not_controller};
  }

  Campaign campaign_;
  Plan plan_;
  int jobs_;
  const std::atomic<bool>& stop_;
  CampaignGroup at_;                            ///< first group at place_
  std::optional<Result<Place>> place_;          ///< place of the last group; empty before the first
  std::map<std::uint64_t, std::string> ready_;  ///< results of groups driven in advance, by run
};

/// Trial of its JSON. Throws Json::exception for another value.
CampaignTrial trial_in(const Json& json) {
  CampaignTrial trial;
  CampaignTrial::rows(trial, [&](const char* name, auto& value) {
    if (std::string_view(name) != kDuration) json.at(name).get_to(value);
  });
  const std::string lasts = json.at(kDuration);
  trial.duration = lasts == kLasts ? run::kLasting : number_in(lasts).value_or(0.0);
  return trial;
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
  plan.axes = {list_axis("track", campaign.tracks), list_axis("car", campaign.cars),
               list_axis("preset", campaign.presets), list_axis("fault", faults_of(campaign)),
               list_axis(kDuration, durations)};
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

RunRule rule_of(const Campaign& campaign, int jobs, const std::atomic<bool>& stop) {
  return [driver = std::make_shared<Driver>(campaign, jobs, stop)](std::uint64_t run, run::Roads&) {
    return driver->drive(run);
  };
}

Result<CampaignGroup> group_of(const Json& line) {
  try {
    const Json& settings = line.at("settings");
    CampaignGroup group{.track = plain_text(settings.at("track")),
                        .car = plain_text(settings.at("car")),
                        .preset = plain_text(settings.at("preset")),
                        .fault = settings.at("fault"),
                        .lasts = plain_text(settings.at(kDuration)),
                        .error = line.value("error", "")};
    for (const Json& trial : line.value("trials", Json::array())) group.trials.push_back(trial_in(trial));
    return group;
  } catch (const Json::exception&) {
    return fail(ErrorCode::kParse,
                fmt::format("got {}, expected a group of trials", printable(protocol::json_text(line))));
  }
}

}  // namespace chicane::sweep
