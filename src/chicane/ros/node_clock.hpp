// SPDX-License-Identifier: MIT
// Time of a ROS 2 node: stamps of messages checked against arrival times, and simulated time by /clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace chicane::ros {

/// Watches the stamps of a topic by the arrival times of its messages: detects repeated and late stamps,
/// clocks that jump, and simulated time. Reads no clock itself. One thread.
class ClockWatch {
 public:
  static constexpr double kJump = 0.5;  ///< least jump of a clock that is reported [s]; chosen

  explicit ClockWatch(std::string topic) : topic_{std::move(topic)} {}

  /// Takes a message with `stamp` that arrived at `received` by the monotonic clock and at `system` by the
  /// system clock of this machine [ns]. True if it is newer than all before, or the first after a jump.
  [[nodiscard]] bool accept(std::int64_t stamp, std::int64_t received, std::int64_t system);
  /// Stamp of the last accepted message as a time of the monotonic clock [ns], at most kLatest before its
  /// arrival. The fastest recent message is assumed to have had no delay, so that delays of others do not
  /// look like motion.
  [[nodiscard]] std::int64_t moment() const { return last_ ? last_->stamp + offset_ : 0; }
  static constexpr double kLatest = 0.1;  ///< longest delay that is compensated [s]; chosen
  /// Newest sentence for the user since the last call; empty: none.
  [[nodiscard]] std::string news();
  /// Forgets the clock of the sender, for another sender.
  void forget() { last_.reset(); }

 private:
  /// Stamp and monotonic arrival time of a message [ns].
  struct Arrival {
    std::int64_t stamp = 0, received = 0;
  };
  /// Updates offset_ by a message whose arrival is `lag` [ns] after its stamp, `since` [s] after the last
  /// one.
  void follow(std::int64_t lag, double since);

  std::string topic_;
  std::optional<Arrival> last_;    ///< last accepted message; none: the next one begins a clock
  std::string news_{};             ///< sentence for news()
  std::int64_t offset_ = 0;        ///< monotonic clock less stamp, of the fastest messages [ns]
  bool is_simulated_ = false;      ///< the stamps are hours from this machine's time
  bool has_said_dropped_ = false;  ///< messages that are left out were reported
};

/// Time of a node: that of this machine, or of /clock, which stands still without messages. Expressed as
/// points of the monotonic clock, from the node's start on. One thread.
class NodeClock {
 public:
  using Clock = std::chrono::steady_clock;

  explicit NodeClock(bool is_simulated) : is_simulated_{is_simulated} {}

  [[nodiscard]] bool is_simulated() const { return is_simulated_; }
  /// Takes the `time` of a message of /clock [ns]. Returns a sentence for the user, or nothing. If /clock
  /// goes back, as at the restart of a simulation, the node's time continues without a step.
  [[nodiscard]] std::string tick(std::int64_t time);

  [[nodiscard]] Clock::time_point now() const {
    return is_simulated_ ? base_ + std::chrono::nanoseconds(time_ - first_) : Clock::now();
  }
  /// Present time as a stamp [ns]: since 1970, or of /clock.
  [[nodiscard]] std::int64_t stamp_now() const;

 private:
  bool is_simulated_;
  bool has_ticked_ = false;                ///< a message of /clock has come
  Clock::time_point base_ = Clock::now();  ///< node's time at first_
  std::int64_t first_ = 0, time_ = 0;      ///< /clock at its start or last step back, and now [ns]
};

}  // namespace chicane::ros
