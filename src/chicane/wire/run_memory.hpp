// SPDX-License-Identifier: MIT
// Memory of a run for viewers that connect late, and congestion control for viewers on slow links.
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

/// Message that is kept for viewers that connect later.
struct KeptMessage {
  std::uint64_t number = 0;  ///< rises from message to message, also across forget()
  double time = 0.0;         ///< time of the run [s]
  std::string payload{};     ///< encoded content
};

/// History of a run as encoded messages in bounded memory, for viewers that connect late: laps, changes of
/// settings, and frames. The newest frames are all kept, older ones thinned. A reader remembers the number up
/// to which it has messages, and asks for the next one; frames it reads backwards.
class RunMemory {
 public:
  // Chosen.
  static constexpr double kDense = 60.0;            ///< time for which all frames are kept [s]
  static constexpr double kSpacing = 0.2;           ///< least time between older frames [s]
  static constexpr std::size_t kMostDense = 3600;   ///< most frames of the dense part
  static constexpr std::size_t kMostSparse = 3000;  ///< most older frames: ten minutes
  static constexpr std::size_t kMostLaps = 1000;    ///< most laps: the best one and the newest ones
  static constexpr std::size_t kMostChanges = 500;  ///< most changes of settings

  /// Drops all messages, because the run restarts.
  void forget();
  /// Adds a frame at the run's `time` [s], which rises.
  void add_frame(double time, std::string payload);
  void add_lap(const telemetry::CompletedLap& lap, double time, std::string payload);
  void add_change(double time, std::string payload);

  // Pointers to messages are valid until the next addition.
  /// Newest frame with a lower number; null: none.
  [[nodiscard]] const KeptMessage* frame_before(std::uint64_t number) const;
  /// Count of the frames with a lower number.
  [[nodiscard]] std::size_t frames_before(std::uint64_t number) const;
  /// Number above those of all messages so far.
  [[nodiscard]] std::uint64_t end() const { return next_; }
  /// Oldest lap with this number or a higher one; null: none.
  [[nodiscard]] const KeptMessage* lap_from(std::uint64_t number) const;
  /// Oldest change with this number or a higher one; null: none.
  [[nodiscard]] const KeptMessage* change_from(std::uint64_t number) const;

 private:
  struct KeptLap : KeptMessage {
    double lap_time = 0.0;  ///< [s]
    bool is_clean = false;  ///< no tyre left the road
  };
  /// Removes the oldest lap that is not the best one. A clean lap is better than any other.
  void drop_lap();

  std::deque<KeptMessage> sparse_, dense_;  ///< older frames, and the newest ones
  std::deque<KeptLap> laps_;
  std::deque<KeptMessage> changes_;
  std::uint64_t next_ = 1;  ///< number of the next message
};

/// Congestion control by delay, after LEDBAT (RFC 6817): limits the bytes in flight to a reader that
/// acknowledges them, so that the next message arrives soon. The window grows while acknowledgements come
/// soon after their messages; when they come late it shrinks to what the link carries in the aimed time.
/// Delays count wherever they arise: in sockets, in proxies, or in a busy reader. One thread.
class LinkPace {
 public:
  // Chosen.
  static constexpr double kDelayAimed = 0.15;  ///< aimed delay in queues, beyond the shortest round trip [s]
  static constexpr std::size_t kLeast = std::size_t{12} << 10U;  ///< least window [byte]
  static constexpr std::size_t kFirst = std::size_t{24} << 10U;  ///< first window [byte]
  static constexpr std::size_t kMost = std::size_t{1} << 20U;    ///< largest window [byte]

  /// Counts a message of `bytes` bytes sent at `now` [s].
  void sent(std::size_t bytes, double now) {
    sent_ += bytes;
    on_way_.push_back({sent_, in_flight(), now});
  }

  /// Takes an acknowledgement at `now` [s]: the reader has read `total` bytes since it connected. Ignores
  /// totals that fall, or exceed the bytes sent.
  void received(std::uint64_t total, double now) {
    if (total <= received_ || total > sent_) return;
    const auto newly = static_cast<std::size_t>(total - received_);
    received_ = total;
    Sent last{};
    while (!on_way_.empty() && on_way_.front().total <= total) {
      last = on_way_.front();
      on_way_.pop_front();
    }
    if (last.total == 0) return;  // acknowledges a part of a message only
    // A single long round trip may come from a busy machine: take the shorter one of the last two.
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
  /// Limit of the bytes in flight.
  [[nodiscard]] std::size_t window() const { return window_; }
  /// Whether another message may be sent. `reserve`: bytes beyond the window, for urgent messages.
  [[nodiscard]] bool has_room(std::size_t reserve = 0) const { return in_flight() < window_ + reserve; }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  /// Message in flight.
  struct Sent {
    std::uint64_t total = 0;    ///< bytes sent up to its end
    std::size_t in_flight = 0;  ///< bytes in flight when it was sent, itself included
    double at = 0.0;            ///< time of sending [s]
  };
  std::deque<Sent> on_way_;                ///< messages in flight, the oldest first
  std::uint64_t sent_ = 0, received_ = 0;  ///< bytes sent, and acknowledged
  std::size_t window_ = kFirst;            ///< limit of the bytes in flight
  double before_ = kInfinity;              ///< round trip before the newest one [s]
  double shortest_ = kInfinity;            ///< shortest round trip so far [s]
};

}  // namespace chicane::wire
