// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
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
  std::size_t log = 0;                       ///< index of the recording; 0 in a live run
  recording::BranchOptions options{};        ///< `drives_both`: the recorded future is driven on, too
  static constexpr double kLongest = 600.0;  ///< [s] of each future
  static constexpr std::size_t kMostSettings = 64;
};

/// Reads {"at_s":12.5,"for_s":20,"laps":1,"log":0,"settings":{"latency_ms":60}}. `at_s` null or absent: from
/// now on; `laps`: the line is crossed so often, whatever is reached first. kInvalidArgument in a sentence
/// for viewers.
[[nodiscard]] Result<WhatIfQuestion> read_question(std::string_view json);

/// Answers one question at a time, by computing the run again and driving both futures, on a thread of its
/// own with low priority: control never waits. A new question takes the place of the one before. ask() and
/// answer() are one thread's, the network thread.
class WhatIf {
 public:
  /// Computes a question; called on the other thread. `hooks` are handed on to recording::branch_run().
  using Compute = std::function<Result<recording::BranchReport>(const WhatIfQuestion& question,
                                                                const recording::BranchHooks& hooks)>;

  explicit WhatIf(Compute compute);

  /// Begins, and does not wait; the number of the question, as a text.
  [[nodiscard]] Result<std::string> ask(std::string_view json);
  /// The newest answer, or how far it is: GET /what_if.json (docs/viewer.md).
  [[nodiscard]] std::string answer();

 private:
  struct Request {
    std::uint64_t number = 0;
    WhatIfQuestion question;
  };
  [[nodiscard]] std::string computed(const Request& request, const std::function<bool()>& is_wanted);

  Compute compute_;
  std::uint64_t newest_ = 0;        ///< number of the last question
  std::atomic<double> share_{0.0};  ///< share of the current question that is computed
  std::string answer_ = R"({"id":0,"state":"none"})";
  run::NewestTask<Request, std::string> task_;  // last
};

/// A second car on the stage of a live run: a shadow run on the same track, with the same car, seed and
/// faults and other settings, from the start line on. It is driven on a thread of its own, of low priority,
/// up to where the run is by its log; the run's thread does nothing for it.
///
/// What acts on the world (faults, and settings of plant, sensor and latency) acts on both at the same cycle;
/// settings of the controller that change meanwhile act on the run's own car alone. The race ends when the
/// run begins with other choices, or when the rival is lost.
class Rival {
 public:
  static constexpr std::size_t kMostLaps = 100;  ///< reported of each car, the newest
  static constexpr std::size_t kTrace = 125;     ///< poses reported of the rival, the newest: five seconds

  /// `log` outlives this. `begin_anew` is called on the rival's thread when it is ready: both begin at the
  /// line.
  Rival(RunLog& log, std::function<void()> begin_anew);

  /// Begins a race of `scenario`, on the network thread: {"settings":{"latency_ms":60}}; {} ends it. Returns
  /// the number of the race, as a text. kInvalidArgument in a sentence for viewers: for a setting that is
  /// unknown, out of range, or fixed during a run.
  [[nodiscard]] Result<std::string> ask(std::string_view json, const scenario::Scenario& scenario);
  /// GET /rival.json (docs/viewer.md). Any thread.
  [[nodiscard]] std::string answer() const;

 private:
  enum class State { kNone, kBuilding, kWaiting, kRacing, kEnded, kFailed };
  struct Request {
    scenario::Scenario scenario;
    std::vector<std::pair<std::string, std::string>> settings;
  };
  static constexpr std::array kColumns{"time_s",    "x_m",       "y_m",       "yaw_rad",
                                       "steer_rad", "speed_mps", "distance_m"};

  void work();
  void build(const Request& request);
  void catch_up();
  void take(const RunLog::Step& step);
  void take(const RunLog::Change& change);
  void take(const telemetry::CompletedLap& lap) { keep(laps_of_run_, lap); }
  void note(const run::ClosedLoop& loop);
  void begin();
  void end(State state, std::string why);
  void keep(std::vector<telemetry::CompletedLap>& laps, const telemetry::CompletedLap& lap) const;
  [[nodiscard]] bool is_racing() const;

  RunLog& log_;
  std::function<void()> begin_anew_;

  // The rival's thread:
  std::optional<recording::ShadowRun> car_;
  RunLog::Place place_;  ///< place in the run's log that the rival has reached

  mutable std::mutex mutex_;  ///< guards all below
  std::optional<Request> request_;
  std::uint64_t newest_ = 0;
  State state_ = State::kNone;
  std::string why_;
  std::vector<std::pair<std::string, std::string>> settings_;
  std::vector<telemetry::CompletedLap> laps_of_run_, laps_;
  std::deque<std::array<double, kColumns.size()>> trace_;
  run::Worker worker_;  // last
};

}  // namespace chicane::live
