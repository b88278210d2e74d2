// SPDX-License-Identifier: MIT
// Campaign of faults, alone and in pairs, at moments of a flying lap: a sweep in which each run is a group of
// trials.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/plan.hpp"
#include "chicane/sweep/sweep.hpp"

namespace chicane::sweep {

/// Choice of trials: all tracks × cars × presets × faults × durations.
struct Campaign {
  std::vector<std::string> tracks{}, cars{}, presets{};
  std::vector<std::string> faults{};  ///< names of kinds of faults
  bool has_pairs = false;             ///< also each pair of faults at once
  /// Durations of the faults [s], run::kLasting: to the end; empty: each fault's own.
  std::vector<double> durations{};
  int onsets = 0;          ///< number of random moments for each group; 0: one each `step`
  std::uint64_t seed = 1;  ///< seed of the random moments
  double step = 0.5;       ///< time between moments [s]
  Settings settings{};     ///< settings of all runs
};

/// Names of the faults of measurement, link and computer: those that leave car and road as they are.
[[nodiscard]] std::vector<std::string> signal_faults();

/// Plan of a campaign: axes track, car, preset, fault ("link_lost+gps_noise") and for_s ("2", "inf", "own").
[[nodiscard]] Plan plan_of(const Campaign& campaign);

/// Result of one trial: a flying lap in which the faults of its group begin at one moment.
struct CampaignTrial {
  double at = 0.0;        ///< start of the faults by the clock of the run [s]
  double until = 0.0;     ///< end of the trial [s]
  double duration = 0.0;  ///< duration of the faults [s]; run::kLasting: to the end
  /// Least gap from a tyre to the road's edge since the start [m]; < 0: off the road.
  double least_edge = 0.0;
  bool is_off_anyway = false;  ///< the run without faults leaves the road in the same time, too
  bool stands = false;         ///< the car stands at the end of the trial
  std::int64_t replaced = 0;   ///< control steps whose command was not the controller's own

  /// Calls `row` with the key in JSON and the member of each value. `Self`: CampaignTrial, const or not.
  template <class Self, class Row>
  static void rows(Self& trial, Row&& row) {
    row("at_s", trial.at);
    row("until_s", trial.until);
    row("for_s", trial.duration);
    row("least_edge_m", trial.least_edge);
    row("off_anyway", trial.is_off_anyway);
    row("stands", trial.stands);
    row("not_controller", trial.replaced);
  }
};

/// Trials of one fault or pair and one duration with one track, car and preset: a line of the results.
struct CampaignGroup {
  std::string track{}, car{}, preset{}, fault{};
  std::string lasts{};  ///< duration as in the plan's axis for_s
  std::vector<CampaignTrial> trials{};
  std::string error{};  ///< error if no trial could be driven; else empty
};

/// Settings of the run that repeats a trial (trial.hpp).
[[nodiscard]] Settings settings_of(const Settings& fixed, const CampaignGroup& group,
                                   const CampaignTrial& trial);

/// Rule for drive_plan() that drives one group of trials. drive_plan() gets one thread: the trials have
/// `jobs` threads (run::drive_trials()) and share the laps before the faults. A result line depends only on
/// the campaign and the number of the run.
[[nodiscard]] RunRule rule_of(const Campaign& campaign, int jobs, const std::atomic<bool>& stop);

/// Group of a line of the results. kParse for another line.
[[nodiscard]] Result<CampaignGroup> group_of(const protocol::Json& line);

}  // namespace chicane::sweep
