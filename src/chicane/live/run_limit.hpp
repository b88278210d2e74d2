// SPDX-License-Identifier: MIT
// Physical limit of the current run, searched beside it and compared with its laps.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "chicane/lap_time/limit.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/worker.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::live {

/// Physical limit of the current run, for any controller and simulator: searched beside the run, reported to
/// viewers and recordings, and compared with the laps at the end. All functions belong to the control thread;
/// `on_news` is called on others, too.
class RunLimit {
 public:
  /// Longest wait for a limit after the end of a run; chosen: kBudget on an idle processor.
  static constexpr std::chrono::seconds kPatience{60};
  /// Work after which a search gives up (lap_time::PlanProgress) [s]. Chosen: more than any car in full size
  /// needs on a track that ships.
  static constexpr double kBudget = 60.0;

  /// `on_news` gets each answer: the result of a search, or that the earlier result is void. Mostly called on
  /// another thread; may be empty; outlives this.
  explicit RunLimit(std::function<void(const lap_time::LimitAnswer&)> on_news = {});

  /// First answer for viewers of a run on this road. An open road has no laps and no limit.
  [[nodiscard]] static lap_time::LimitAnswer first_answer(const road::Track& track);
  /// Starts another run: gives up the earlier search, and begins a new one if the road is closed. Does not
  /// wait.
  void search(const road::Track& track, const scenario::Scenario& scenario);
  /// Follows changes of grip and mass; call it after each control cycle. A change makes the limit void, which
  /// is reported. Once both have been constant for a moment, a new search begins, for the laps from then on.
  /// Does not wait.
  void follow(const scenario::Scenario& now, const telemetry::Frame& frame);
  /// Begins a run whose limit cannot be computed, for the reason `why`.
  void give_up(std::string why);

  /// Newest answer, returned once; null if nothing is new. Neither waits nor allocates.
  [[nodiscard]] std::shared_ptr<const lap_time::LimitAnswer> news() noexcept;
  /// Whether a search is running.
  [[nodiscard]] bool is_searching() const noexcept { return begins_at_ || search_.is_computing(); }

  /// Whether a search is running, and there are laps to compare with its result.
  [[nodiscard]] bool is_awaited(const telemetry::RunSummary& run) const noexcept;

  /// Ends a search and all news. Does not wait.
  void end();
  /// Ends the run: compares its laps with the limit, or gives the reason against it. Waits while
  /// is_awaited(), until `wants_stop`, and for no longer than `patience`.
  void compare(telemetry::RunSummary& run, const std::atomic<bool>& wants_stop,
               std::chrono::milliseconds patience = kPatience);

 private:
  using Clock = std::chrono::steady_clock;
  /// Inputs of a search.
  struct Request {
    road::Track track;
    scenario::Scenario scenario;
    int first_lap = 1;  ///< LimitAnswer::first_lap
  };

  /// Answer from the cache, if it is known (run/plan_cache.hpp); else from a search.
  static lap_time::LimitAnswer found(const Request& request, const std::function<bool()>& is_wanted);
  /// Begins a search with the newest settings.
  void begin();
  /// Drops the search and its answer.
  void retire();
  /// Publishes an answer.
  void tell(lap_time::LimitAnswer answer);

  std::function<void(const lap_time::LimitAnswer&)> on_news_;
  std::shared_ptr<const lap_time::LimitAnswer> answer_;  ///< written by the search while it runs
  std::atomic<bool> has_news_{false};                    ///< an answer waits to be read
  std::optional<road::Track> track_;            ///< track of the run; none if nothing is to be searched
  scenario::Scenario scenario_;                 ///< scenario with the grip and mass of the newest search
  int first_lap_ = 1;                           ///< LimitAnswer::first_lap
  std::optional<Clock::time_point> begins_at_;  ///< the next search, when nothing changes until then
  run::NewestTask<Request, lap_time::LimitAnswer> search_;  ///< last member: its thread uses the others
};

}  // namespace chicane::live
