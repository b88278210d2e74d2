// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace chicane::ros {

/// Compares the stamps of a topic with the time at which its messages arrive: finds stamps that come twice or
/// in the wrong order, clocks that jump, and simulated time. Clocks come in. One thread.
class ClockWatch {
 public:
  static constexpr double kJump = 0.5;  ///< a change of the clock that is said [s]

  explicit ClockWatch(std::string topic) : topic_{std::move(topic)} {}

  /// A message with `stamp` arrived at `received`, by this machine's monotonic and its system clock [ns].
  /// True: it is newer than those before, or the first after a jump.
  [[nodiscard]] bool accept(std::int64_t stamp, std::int64_t received, std::int64_t system);
  /// When the last accepted message was stamped, by this machine's monotonic clock [ns]: the quickest of the
  /// last messages is taken to have come at once, so that what others waited for does not look like motion.
  /// At most kLatest before it arrived.
  [[nodiscard]] std::int64_t moment() const { return last_ ? last_->stamp + offset_ : 0; }
  static constexpr double kLatest = 0.1;  ///< [s]
  /// What is to be said since the last call; empty: nothing.
  [[nodiscard]] std::string news();
  /// Messages that were dropped, because they came twice or too late.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// The stamps are not this machine's time: of /clock, or of a machine whose clock differs by hours.
  [[nodiscard]] bool is_simulated() const { return is_simulated_; }
  /// Another sender: nothing known of its clock.
  void forget() { last_.reset(); }

 private:
  struct Arrival {
    std::int64_t stamp = 0, received = 0;
  };
  void say(std::string line);
  void follow(std::int64_t lag, double since);

  std::string topic_;
  std::optional<Arrival> last_;
  std::string news_{};
  std::int64_t offset_ = 0;  ///< from stamps to the monotonic clock, of the quickest messages [ns]
  std::uint64_t dropped_ = 0;
  bool is_simulated_ = false;
  bool has_said_dropped_ = false;
};

/// The time by which a node counts: this machine's, or that of /clock, which stands where nobody sends it. As
/// points of the monotonic clock, which begin when the node does. One thread.
class NodeClock {
 public:
  using Clock = std::chrono::steady_clock;

  explicit NodeClock(bool is_simulated) : is_simulated_{is_simulated} {}

  [[nodiscard]] bool is_simulated() const { return is_simulated_; }
  /// /clock says that it is `time` [ns]. What is to be said of it; empty: nothing. A time that goes back, as
  /// where a simulation begins anew, is where the node's time goes on.
  [[nodiscard]] std::string tick(std::int64_t time);

  [[nodiscard]] Clock::time_point now() const {
    return is_simulated_ ? base_ + std::chrono::nanoseconds(time_ - first_) : Clock::now();
  }
  /// Now in the numbers of stamps [ns]: since 1970, or of /clock.
  [[nodiscard]] std::int64_t stamp_now() const;

 private:
  bool is_simulated_;
  bool has_ticked_ = false;
  Clock::time_point base_ = Clock::now();  ///< when /clock had `first_`
  std::int64_t first_ = 0, time_ = 0;      ///< [ns]
};

}  // namespace chicane::ros
