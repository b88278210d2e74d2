// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <utility>

#include "chicane/telemetry/frame.hpp"

namespace chicane::wire {

/// A message that is kept for viewers that come later.
struct KeptMessage {
  std::uint64_t number = 0;  ///< rises from message to message, also beyond forget()
  double time = 0.0;         ///< time of the run [s]
  std::string payload{};     ///< encoded
};

/// History of a run as encoded messages in bounded memory, for viewers that connect late: laps, changes of
/// settings, and frames, the newest frames all, older ones thinned. A reader keeps the number of the next
/// message that it wants, and asks for the first from there on, or, for frames, the last one before.
class RunMemory {
 public:
  static constexpr double kDense = 60.0;   ///< all frames of the last ... [s]
  static constexpr double kSpacing = 0.2;  ///< least spacing of older frames [s]
  static constexpr std::size_t kMostDense = 3600;
  static constexpr std::size_t kMostSparse = 3000;  ///< ten minutes
  static constexpr std::size_t kMostLaps = 1000;    ///< the newest and the best
  static constexpr std::size_t kMostChanges = 500;

  /// Drops everything: the run restarts.
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

/// Limit of bytes in flight to a reader that acknowledges them, so that the next message arrives soon:
/// congestion control by delay, after LEDBAT (RFC 6817). The window grows while acknowledgements come soon
/// after the message, and shrinks to the link's capacity in that time if they come later. It covers
/// everything between the two programs: sockets, proxies, and a reader that is busy for long. One thread.
class LinkPace {
 public:
  static constexpr double kDelayAimed = 0.15;  ///< in queues on the way, beyond the shortest round trip [s]
  static constexpr std::size_t kLeast = std::size_t{12} << 10U;  ///< window [byte]
  static constexpr std::size_t kFirst = std::size_t{24} << 10U;  ///< window at the beginning [byte]
  static constexpr std::size_t kMost = std::size_t{1} << 20U;    ///< window [byte]

  /// Counts a message of `bytes` bytes sent at `now` [s].
  void sent(std::size_t bytes, double now) {
    sent_ += bytes;
    on_way_.push_back({sent_, in_flight(), now});
  }

  /// The reader has read `total` bytes since it came. Numbers that were never sent, or go back, change
  /// nothing.
  void received(std::uint64_t total, double now) {
    if (total <= received_ || total > sent_) return;
    const auto newly = static_cast<std::size_t>(total - received_);
    received_ = total;
    Sent last{};
    while (!on_way_.empty() && on_way_.front().total <= total) {
      last = on_way_.front();
      on_way_.pop_front();
    }
    if (last.total == 0) return;  // a part of a message
    // One that was held up by a busy machine says nothing of the way: two in a row do.
    const double newest = now - last.at;
    const double round_trip = std::min(newest, std::exchange(before_, newest));
    shortest_ = std::min(shortest_, newest);
    if (newest - shortest_ < kDelayAimed) {
      if (last.in_flight * 2 >= window_) window_ = std::min(kMost, window_ + newly);
    } else if (round_trip - shortest_ >= kDelayAimed) {
      const double carried = static_cast<double>(last.in_flight) * (shortest_ + kDelayAimed) / round_trip;
      window_ = std::clamp(static_cast<std::size_t>(carried), kLeast, std::max(kLeast, window_));
    }
  }

  /// Bytes that were sent and not acknowledged.
  [[nodiscard]] std::size_t in_flight() const { return static_cast<std::size_t>(sent_ - received_); }
  /// Bytes that the reader has acknowledged.
  [[nodiscard]] std::uint64_t received() const { return received_; }
  [[nodiscard]] std::size_t window() const { return window_; }
  /// `reserve`: beyond the window, for what must not wait behind other things [byte].
  [[nodiscard]] bool has_room(std::size_t reserve = 0) const { return in_flight() < window_ + reserve; }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Sent {
    std::uint64_t total = 0;    ///< bytes sent up to its end
    std::size_t in_flight = 0;  ///< bytes in flight including it [byte]
    double at = 0.0;            ///< [s]
  };
  std::deque<Sent> on_way_;
  std::uint64_t sent_ = 0, received_ = 0;  ///< [byte]
  std::size_t window_ = kFirst;
  double before_ = kInfinity;    ///< the round trip before the newest [s]
  double shortest_ = kInfinity;  ///< round trip [s]
};

}  // namespace chicane::wire
