// SPDX-License-Identifier: MIT
// Questions of viewers about a run with other settings: its other future (WhatIf), or a second car (Rival).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/live/run_log.hpp"
#include "chicane/recording/shadow_run.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/worker.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::live {

/// Question of a viewer: how would the run continue from a moment on with other settings?
struct WhatIfQuestion {
  std::size_t log = 0;                              ///< index of the recording; 0 in a live run
  recording::BranchOptions options{};               ///< moment, settings and duration; `drives_both` is true
  static constexpr double kLongest = 600.0;         ///< longest duration of each future [s]; chosen
  static constexpr std::size_t kMostSettings = 64;  ///< most settings of a question; chosen
};

/// Reads a question: {"at_s":12.5,"for_s":20,"laps":1,"log":0,"settings":{"latency_ms":60}}. Without `at_s`
/// the moment is now. The future ends after `for_s` or after `laps` crossings of the line, whatever comes
/// first. kInvalidArgument in a sentence for viewers.
[[nodiscard]] Result<WhatIfQuestion> read_question(std::string_view json);

/// Answers one question at a time on a thread of low priority: computes the run again and drives both
/// futures. Control never waits. A new question replaces the one before. ask() and answer() belong to one
/// thread, the network thread.
class WhatIf {
 public:
  /// Computes the answer to a question on the thread of low priority. `hooks` are for
  /// recording::branch_run().
  using Compute = std::function<Result<recording::BranchReport>(const WhatIfQuestion& question,
                                                                const recording::BranchHooks& hooks)>;

  explicit WhatIf(Compute compute);

  /// Begins to answer a question, and does not wait. Returns the number of the question, as a text.
  [[nodiscard]] Result<std::string> ask(std::string_view json);
  /// Text for GET /what_if.json (docs/viewer.md): the newest answer, or the progress of its computation.
  [[nodiscard]] std::string answer();

 private:
  struct Request {
    std::uint64_t number = 0;
    WhatIfQuestion question;
  };
  /// Answer as JSON, computed on the task's thread.
  [[nodiscard]] std::string computed(const Request& request, const std::function<bool()>& is_wanted);

  Compute compute_;
  std::uint64_t newest_ = 0;                           ///< number of the last question
  std::atomic<double> share_{0.0};                     ///< share of the current question that is computed
  std::string answer_ = R"({"id":0,"state":"none"})";  ///< newest answer; empty while it is computed
  run::NewestTask<Request, std::string> task_;         ///< last member: its thread uses the others
};

/// Second car beside a live run: a shadow run from the start line on, on the same track, with the same car,
/// seed and faults, and with other settings. A thread of low priority drives it up to where the run is by its
/// log; the thread of the run does nothing for it.
///
/// Changes that act on the world (faults, settings of plant, sensor and latency) act on both cars at the same
/// cycle. Settings of the controller that change meanwhile act on the car of the run only. The race ends when
/// another run begins, or when the rival is lost.
class Rival {
 public:
  static constexpr std::size_t kMostLaps = 100;  ///< newest laps of each car that are reported; chosen
  static constexpr std::size_t kTrace = 125;     ///< newest poses of the rival that are reported; chosen: 5 s

  /// `log` outlives this. `begin_anew` is called on the rival's thread when the rival is ready: it has to
  /// restart the run, so that both cars begin at the line.
  Rival(RunLog& log, std::function<void()> begin_anew);

  /// Begins a race of `scenario` with the settings in {"settings":{"latency_ms":60}}, or ends it with {};
  /// called on the network thread. Returns the number of the race, as a text. kInvalidArgument in a sentence
  /// for viewers: for a setting that is unknown, out of range, or fixed during a run.
  [[nodiscard]] Result<std::string> ask(std::string_view json, const scenario::Scenario& scenario);
  /// Text for GET /rival.json (docs/viewer.md). Any thread.
  [[nodiscard]] std::string answer() const;

 private:
  enum class State { kNone, kBuilding, kWaiting, kRacing, kEnded, kFailed };
  struct Request {
    scenario::Scenario scenario;
    std::vector<std::pair<std::string, std::string>> settings;
  };
  static constexpr std::array kColumns{"time_s",    "x_m",       "y_m",       "yaw_rad",
                                       "steer_rad", "speed_mps", "distance_m"};

  // Functions of the rival's thread.
  void work();
  /// Builds the rival of a request, or ends the race.
  void build(const Request& request);
  /// Drives the rival up to the run's time.
  void catch_up();
  void take(const RunLog::Step& step);
  void take(const RunLog::Change& change);
  void take(const telemetry::CompletedLap& lap) { keep(laps_of_run_, lap); }
  /// Adds the rival's pose to the trace.
  void note(const run::ClosedLoop& loop);
  /// Begins the race at the start line.
  void begin();
  /// Ends the race, for the reason `why`.
  void end(std::string why);
  /// Appends a lap, and drops the oldest one if there are too many.
  void keep(std::vector<telemetry::CompletedLap>& laps, const telemetry::CompletedLap& lap) const;
  [[nodiscard]] bool is_racing() const;

  RunLog& log_;
  std::function<void()> begin_anew_;

  // Used by the rival's thread only.
  std::optional<recording::ShadowRun> car_;  ///< the rival; none: no race
  RunLog::Place place_;                      ///< place in the run's log that the rival has reached

  mutable std::mutex mutex_;                                   ///< guards all below
  std::optional<Request> request_;                             ///< request that waits for the rival's thread
  std::uint64_t newest_ = 0;                                   ///< number of the last request
  State state_ = State::kNone;                                 ///< state of the race
  std::string why_;                                            ///< reason of its end or failure; else empty
  std::vector<std::pair<std::string, std::string>> settings_;  ///< settings of the rival
  std::vector<telemetry::CompletedLap> laps_of_run_, laps_;    ///< newest laps of the run and of the rival
  std::deque<std::array<double, kColumns.size()>> trace_;      ///< newest poses of the rival, by kColumns
  run::Worker worker_;                                         ///< last member: its thread uses the others
};

}  // namespace chicane::live
