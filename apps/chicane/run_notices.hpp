// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chicane/telemetry/frame.hpp"

namespace chicane::apps {

/// Finds in the frames of a run what its operator has to know at once: that the guard replaces the
/// controller's commands, and why; that the car stands, and why. At most two lines for each second of the
/// run.
class RunNotices {
 public:
  static constexpr double kPause = 1.0;          ///< without intervention: it has ended [s]
  static constexpr double kStoodTime = 2.0;      ///< standstill before it is reported [s]
  static constexpr double kStandingSpeed = 0.1;  ///< slower: the car stands [m/s]
  static constexpr double kMovingSpeed = 0.5;    ///< faster: it moves again [m/s]

  /// The lines that a frame gives rise to; mostly none.
  [[nodiscard]] std::vector<std::string> look_at(const telemetry::Frame& frame);

 private:
  using Lines = std::vector<std::string>;
  void watch_guard(const telemetry::Frame& frame, Lines& lines);
  void watch_standing(const telemetry::Frame& frame, Lines& lines);

  double last_time_ = 0.0;
  // The intervention that goes on, or ended less than kPause ago.
  std::string intervention_;  ///< sentence printed last; empty: none
  std::uint64_t steps_ = 0;   ///< count of replaced commands
  double began_ = 0.0;        ///< [s]
  double ended_ = 0.0;        ///< first step of the controller after the last replaced command [s]
  double said_ = 0.0;         ///< when the sentence was printed [s]
  bool is_replaced_ = false;  ///< command of the last step
  // Standstill.
  bool stands_ = false;
  bool is_reported_ = false;
  double stood_since_ = 0.0;  ///< [s]
};

}  // namespace chicane::apps
