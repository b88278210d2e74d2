// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "chicane/telemetry/frame.hpp"

namespace chicane::wire {

/// A message that is kept for viewers that come later.
struct KeptMessage {
  std::uint64_t number = 0;  ///< rises from message to message, also beyond forget()
  double time = 0.0;         ///< of the run [s]
  std::string payload{};     ///< encoded
};

/// What a run has been so far, as encoded messages in bounded memory, so that a viewer that comes late knows
/// what the others know: laps, changes of settings, and frames; the newest frames all, older ones at a
/// distance. A reader keeps the number of the next message that it wants, and asks for the first from there
/// on, or, of frames, for the last one before.
class RunMemory {
 public:
  static constexpr double kDense = 60.0;   ///< all frames of the last ... [s]
  static constexpr double kSpacing = 0.2;  ///< between older ones, at least [s]
  static constexpr std::size_t kMostDense = 3600;
  static constexpr std::size_t kMostSparse = 3000;  ///< ten minutes
  static constexpr std::size_t kMostLaps = 1000;    ///< the newest and the best
  static constexpr std::size_t kMostChanges = 500;

  /// The run begins anew.
  void forget();
  /// `time` rises from frame to frame.
  void add_frame(double time, std::string payload);
  void add_lap(const telemetry::CompletedLap& lap, double time, std::string payload);
  void add_change(double time, std::string payload);

  /// The first with this number or a higher one; null when there is none. Valid until the next addition.
  /// The last frame with a lower number, and how many there are; null and 0 when there is none.
  [[nodiscard]] const KeptMessage* frame_before(std::uint64_t number) const;
  [[nodiscard]] std::size_t frames_before(std::uint64_t number) const;
  /// Higher than the number of every message that was added.
  [[nodiscard]] std::uint64_t end() const { return next_; }
  [[nodiscard]] const KeptMessage* lap_from(std::uint64_t number) const;
  [[nodiscard]] const KeptMessage* change_from(std::uint64_t number) const;

 private:
  struct KeptLap : KeptMessage {
    double lap_time = 0.0;  ///< [s]
    bool is_clean = false;
  };
  void drop_lap();

  std::deque<KeptMessage> sparse_, dense_;  ///< frames, older and newest
  std::deque<KeptLap> laps_;
  std::deque<KeptMessage> changes_;
  std::uint64_t next_ = 1;
};

}  // namespace chicane::wire
