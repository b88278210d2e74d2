// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "chicane/telemetry/change.hpp"

namespace chicane::telemetry {

/// With what a lap was driven.
struct LapSetup {
  /// Settings that were changed since the run began, as they were at the end of the lap, by name; also those
  /// that were changed back. `values` as --set takes them, of the same length.
  std::vector<std::string> names{}, values{};
  bool is_mixed = false;              ///< one of them changed while the lap was driven
  double by_hand_share = 0.0;         ///< of its time, driven by a person, in [0, 1]
  std::vector<std::string> faults{};  ///< that acted in it, without "fault.", by name
};

/// Keeps the changes of a run, so that each lap can be told with what it was driven. For threads that write
/// or send: it allocates. Pace and a person's hands are no settings. Of very many changes the older ones are
/// known by their outcome only: laps of long ago cannot be asked for, the newest always.
class LapLedger {
 public:
  static constexpr std::size_t kMostKept = 1024;  ///< changes, one by one

  /// Another run with other choices: nothing was changed yet.
  void begin() { log_.clear(); }
  /// The same run from its start: settings and who drives stay, faults have ended.
  void restart();
  /// In the order of time. One that `starts_anew` begins another run.
  void add(const Change& change);

  /// Of a lap that ended at `end` [s] of the run and took `lap_time` [s].
  [[nodiscard]] LapSetup setup(double end, double lap_time) const;

 private:
  static constexpr double kBefore = -std::numeric_limits<double>::infinity();
  struct Noted {
    double time = kBefore;  ///< [s]
    std::string name{}, value{};
  };
  void fold(std::size_t count);

  std::vector<Noted> log_;
};

}  // namespace chicane::telemetry
