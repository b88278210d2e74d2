// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/live/worker.hpp"
#include "chicane/recording/branch.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/change.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::live {

/// What has to be known of the run that goes on to compute it again, bit for bit, since it began: scenario,
/// changes, and what the clock did to each control step. In memory, about 130 bytes a step, so that a run can
/// be branched without a recording (what_if.hpp).
///
/// The control thread notes; it neither waits nor allocates, but in begin(). A thread of its own collects
/// what was noted. Of a run that is longer than kMostEvents the newest are known, to go on from a checkpoint
/// (recording/checkpoints.hpp). One of which something could not be noted in time is not known any more until
/// the next one begins: told in words by history().
class Journal {
 public:
  static constexpr std::size_t kRing = 4096;           ///< steps and changes that wait for the collector
  static constexpr std::size_t kMostEvents = 200'000;  ///< two hours with 25 steps a second

  Journal();

  /// The control thread: another run begins. Waits for no more than a copy of a pointer.
  void begin(const scenario::Scenario& scenario);
  /// The control thread, after each control step, and after each change was applied.
  void note(const telemetry::Frame& frame) noexcept;
  void note(const telemetry::Change& change) noexcept;

  /// A place between two events of a run, counted from its beginning.
  struct Place {
    std::uint64_t run = 0;  ///< each beginning has a number of its own, from 1
    std::uint64_t event = 0;
    friend bool operator==(const Place&, const Place&) = default;
  };
  struct Excerpt {
    Place begin, end;  ///< `begin.event` 0: the whole run, its scenario first
    recording::RunEvents events;
  };
  /// Any thread: the events from `from` on, or, where that is no place in the present run, of the whole run,
  /// for recording::branch_run(); its time line is the run's. A run that was started anew is known from there
  /// on. kInvalidArgument with the reason when it is not known.
  [[nodiscard]] Result<Excerpt> history(Place from);
  [[nodiscard]] Result<Excerpt> history() { return history(Place{}); }
  /// Any thread: the oldest place from which events are known.
  [[nodiscard]] Place oldest();

 private:
  struct StepNote {
    std::uint64_t cycle = 0;
    double time = 0.0;
    double delay = 0.0;
    std::uint32_t deadline_spent_at = 0;
    bool begins = false;
    std::array<double, 6> seen{};  ///< measured: x, y, psi, speed, steer, throttle
    std::array<double, 2> sent{};
  };
  struct ChangeNote {
    std::uint64_t cycle = 0;
    double time = 0.0;
    std::string name, value;
  };
  using Event = std::variant<StepNote, ChangeNote>;
  struct Entry {
    enum class Kind { kStep, kChange, kBegin } kind = Kind::kStep;
    StepNote step;
    telemetry::Change change;
  };

  bool push(const Entry& entry) noexcept;
  void collect();
  void take(const Entry& entry);
  void add(Event event);
  void start_anew(const StepNote& first);
  static recording::RecordedEvent told(const Event& event);

  std::vector<Entry> ring_;
  std::atomic<std::uint64_t> put_{0};
  std::atomic<std::uint64_t> taken_{0};
  std::atomic<bool> has_lost_{false};  ///< something did not fit into the ring

  std::mutex mutex_;                        ///< of all below
  std::deque<scenario::Scenario> waiting_;  ///< one for each kBegin in the ring
  scenario::Scenario scenario_;
  bool has_begun_ = false;
  const char* why_unknown_ = nullptr;
  std::deque<Event> events_;
  Place first_;    ///< before the first of events_
  Worker worker_;  // last
};

}  // namespace chicane::live
