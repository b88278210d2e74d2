// SPDX-License-Identifier: MIT
// Memory of a live run, from which other futures of it are computed: its events, and copies at checkpoints.
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

/// Events of the current run in memory: scenario, changes, laps, and for each control step the inputs from
/// which it is computed again bit for bit, about 110 bytes. Readers are other futures (what_if.hpp,
/// served_run.hpp) and the second car (what_if.hpp).
///
/// The control thread writes into a ring; it neither waits nor allocates, except in begin(). A thread of low
/// priority empties the ring. The log keeps the newest `most_events` events. After an overflow of the ring
/// the run is unknown until its next start, and since() fails.
///
/// With checkpoints that thread also computes the run a second time, at the cost of its control steps, and
/// keeps copies: kSpacing apart for the last moments, farther apart for earlier ones. The next checkpoint
/// before a moment is at most as long before it as the moment is ago. A run of T seconds needs some 2 log2(T
/// / kSpacing) copies of 8 MB.
class RunLog {
 public:
  static constexpr std::size_t kMostEvents = 200'000;  ///< chosen: two hours at 25 steps a second
  static constexpr double kSpacing = 10.0;             ///< spacing of the newest checkpoints [s]; chosen

  explicit RunLog(bool has_checkpoints, std::size_t most_events = kMostEvents);

  /// Begins another run; called on the control thread.
  void begin(const scenario::Scenario& scenario);
  /// Adds a control step, change or completed lap; called on the control thread.
  void note(const telemetry::Frame& frame) noexcept;
  void note(const telemetry::Change& change) noexcept { put(change); }
  void note(const telemetry::CompletedLap& lap) noexcept { put(lap); }

  /// Place between two events of the log.
  struct Place {
    std::uint64_t scenario = 0;  ///< number of begin(), from 1; 0: before any run
    std::uint64_t start = 0;     ///< number of the start from the line, rising over all runs
    std::uint64_t event = 0;     ///< index of the event since that start
    friend bool operator==(const Place&, const Place&) = default;
    /// Whether both places lie in the same run since the same start.
    [[nodiscard]] bool is_in_start_of(const Place& other) const {
      return scenario == other.scenario && start == other.start;
    }
  };
  /// Inputs and command of a control step.
  struct Step {
    std::uint64_t cycle = 0;
    double time = 0.0;                    ///< [s]
    double delay = 0.0;                   ///< Measurement::delay [s]
    std::uint32_t deadline_spent_at = 0;  ///< DeadlineLog::spent_at
    bool begins = false;                  ///< Frame::begins
    std::array<double, 6> seen{};         ///< measured x, y, psi, speed, steer, throttle
    std::array<double, 2> sent{};         ///< sent steer and throttle
  };
  /// Change of a setting; telemetry::Change with texts of any length, to save memory.
  struct Change {
    std::uint64_t cycle = 0;
    double time = 0.0;  ///< [s]
    std::string name, value;
    [[nodiscard]] telemetry::Change as_recorded() const;
  };
  using Event = std::variant<Step, Change, telemetry::CompletedLap>;
  /// Events between two places.
  struct Excerpt {
    Place begin, end;  ///< `begin.event` 0: the whole run since its start
    std::shared_ptr<const scenario::Scenario> scenario;
    std::shared_ptr<const std::vector<Event>> events;
    /// Events for recording::branch_run(), beginning with the run's scenario.
    [[nodiscard]] recording::RunEvents recorded() const;
  };
  /// Events from `from` on, or of the whole run if `from` is no place in the current run. A restarted run
  /// begins at its start line, with the settings it had there. kInvalidArgument with the reason if the run is
  /// unknown. Any thread.
  [[nodiscard]] Result<Excerpt> since(Place from);
  /// Place after the newest event. Any thread.
  [[nodiscard]] Place end();

  /// Branches the run, from a checkpoint if there is one before `options.at`. Fails as
  /// recording::branch_run() and since() do, and for a moment that the log has dropped. Any thread.
  [[nodiscard]] Result<recording::BranchReport> branch(const recording::BranchOptions& options,
                                                       const recording::BranchHooks& hooks);

 private:
  using Begin = std::shared_ptr<const scenario::Scenario>;  ///< event: a run with this scenario begins
  using Entry = std::variant<Step, telemetry::Change, telemetry::CompletedLap, Begin>;
  /// Copy of the run at a place.
  struct Checkpoint {
    Place place;
    std::shared_ptr<const recording::ShadowRun> run;
  };

  /// Writes an event into the ring.
  template <class Note>
  void put(Note&& note) noexcept {
    if (!ring_.push(std::forward<Note>(note))) has_lost_ = true;
  }
  // Pre of all functions up to last(): mutex_ is held.
  /// Moves new events from the ring into the log.
  void collect();
  void take(Begin& scenario);
  void take(const Step& step);
  void take(const telemetry::Change& change);
  void take(const telemetry::CompletedLap& lap) { add(lap); }
  /// Appends an event, and drops the oldest one if there are too many.
  void add(Event event);
  /// Restarts the log at the first step of a restarted run. Settings stay; faults and driven steps do not.
  void start_anew(const Step& first);
  /// Place after the newest event.
  [[nodiscard]] Place last() const;

  /// Computes the newest events in the shadow run; called on the worker's thread.
  void follow();
  /// Keeps a checkpoint at `place`, if the newest one is kSpacing away.
  void keep(const Place& place);
  /// Removes checkpoints whose neighbours are close enough to each other at their age; `now` [s].
  void thin(double now);

  run::ThreadQueue<Entry, 4096> ring_;  // capacity chosen: minutes of control steps
  std::atomic<bool> has_lost_{false};   ///< an event did not fit into the ring

  const bool has_checkpoints_;
  const std::size_t most_events_;
  std::optional<recording::ShadowRun>
      shadow_;      ///< used by the worker; none: the run cannot be computed again
  Place followed_;  ///< used by the worker: place that shadow_ has reached

  std::mutex mutex_;                     ///< guards all below
  Begin scenario_;                       ///< scenario of the current run; null: no run has begun
  const char* why_unknown_ = nullptr;    ///< reason for which the run is unknown; null: it is known
  std::deque<Event> events_;             ///< events since the start, or the newest of them
  Place first_;                          ///< place before the first of events_
  std::vector<Checkpoint> checkpoints_;  ///< checkpoints by rising time
  run::Worker worker_;                   ///< last member: its thread uses the others
};

}  // namespace chicane::live
