// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/recording/shadow_run.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/run/worker.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::live {

/// Events of the current run, in memory, about 110 bytes a step: scenario, changes, laps, and of each control
/// step all that a bit-identical computation needs. Readers are other futures (what_if.hpp,
/// served_run.hpp) and the second car (what_if.hpp).
///
/// The control thread writes to one ring; it neither waits nor allocates, except in begin(). A thread of low
/// priority collects. The log keeps the newest `most_events` events. After an overflow of the ring the run is
/// unknown until its next start: since() fails.
///
/// With checkpoints the same thread computes the run a second time, at the cost of the run's own control
/// steps, and keeps copies, kSpacing apart for the last moments and farther apart for earlier ones. The
/// distance from a moment back to a checkpoint is at most its age. A run of T seconds needs some 2 log2(T /
/// kSpacing) copies of 8 MB.
class RunLog {
 public:
  static constexpr std::size_t kMostEvents = 200'000;  ///< two hours with 25 steps a second
  static constexpr double kSpacing = 10.0;             ///< spacing of the newest checkpoints [s]

  explicit RunLog(bool has_checkpoints, std::size_t most_events = kMostEvents);

  /// The control thread: another run begins.
  void begin(const scenario::Scenario& scenario);
  /// The control thread, after each control step, change and completed lap.
  void note(const telemetry::Frame& frame) noexcept;
  void note(const telemetry::Change& change) noexcept { put(change); }
  void note(const telemetry::CompletedLap& lap) noexcept { put(lap); }

  /// A place between two events.
  struct Place {
    std::uint64_t scenario = 0;  ///< number of begin(), from 1; 0: before any run
    std::uint64_t start = 0;     ///< number of the start from the line, rising over all runs
    std::uint64_t event = 0;     ///< index of the event since that start
    friend bool operator==(const Place&, const Place&) = default;
    [[nodiscard]] bool is_in_start_of(const Place& other) const {
      return scenario == other.scenario && start == other.start;
    }
  };
  struct Step {
    std::uint64_t cycle = 0;
    double time = 0.0;   ///< [s]
    double delay = 0.0;  ///< Measurement::delay [s]
    std::uint32_t deadline_spent_at = 0;
    bool begins = false;
    std::array<double, 6> seen{};  ///< measured: x, y, psi, speed, steer, throttle
    std::array<double, 2> sent{};  ///< steer, throttle
  };
  struct Change {
    std::uint64_t cycle = 0;
    double time = 0.0;  ///< [s]
    std::string name, value;
    [[nodiscard]] telemetry::Change as_recorded() const;
  };
  using Event = std::variant<Step, Change, telemetry::CompletedLap>;
  struct Excerpt {
    Place begin, end;  ///< `begin.event` 0: the whole run since its start
    std::shared_ptr<const scenario::Scenario> scenario;
    std::shared_ptr<const std::vector<Event>> events;
    /// Events for recording::branch_run(), beginning with the run's scenario.
    [[nodiscard]] recording::RunEvents recorded() const;
  };
  /// Events from `from` on; of the whole run if `from` is no place in the current one. After a restart the
  /// run is known from its start line, with its settings. kInvalidArgument with the reason if the run is not
  /// known. Any thread.
  [[nodiscard]] Result<Excerpt> since(Place from);
  /// Place after the newest event. Any thread.
  [[nodiscard]] Place end();

  /// Branches the run, from a checkpoint if there is one before `options.at`. Fails as
  /// recording::branch_run() and since() do, and for a moment that the log has dropped. Any thread.
  [[nodiscard]] Result<recording::BranchReport> branch(const recording::BranchOptions& options,
                                                       const recording::BranchHooks& hooks);

 private:
  using Begin = std::shared_ptr<const scenario::Scenario>;
  using Entry = std::variant<Step, telemetry::Change, telemetry::CompletedLap, Begin>;
  struct Checkpoint {
    Place place;
    std::shared_ptr<const recording::ShadowRun> run;
  };

  template <class Note>
  void put(Note&& note) noexcept {
    if (!ring_.push(std::forward<Note>(note))) has_lost_ = true;
  }
  void collect();
  void take(Begin& scenario);
  void take(const Step& step);
  void take(const telemetry::Change& change);
  void take(const telemetry::CompletedLap& lap) { add(lap); }
  void add(Event event);
  void start_anew(const Step& first);
  [[nodiscard]] Place last() const;
  void follow();
  void keep(const Place& place);
  void thin(double now);

  run::ThreadQueue<Entry, 4096> ring_;
  std::atomic<bool> has_lost_{false};  ///< something did not fit into the ring

  // The worker's:
  const bool has_checkpoints_;
  const std::size_t most_events_;
  std::optional<recording::ShadowRun> shadow_;  ///< none: a run that cannot be followed
  Place followed_;

  std::mutex mutex_;  ///< guards all below
  Begin scenario_;
  const char* why_unknown_ = nullptr;
  std::deque<Event> events_;
  Place first_;                          ///< place before the first of events_
  std::vector<Checkpoint> checkpoints_;  ///< by rising time; written by the worker
  run::Worker worker_;                   // last
};

}  // namespace chicane::live
