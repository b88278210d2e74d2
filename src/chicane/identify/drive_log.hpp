// SPDX-License-Identifier: MIT
// Logs of driving: the positions of a car and the commands sent to it, without the program that drove it.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::identify {

/// Measured pose of the car, in axes with x forward, y left and yaw positive to the left (docs/notation.md).
struct Sample {
  double time = 0.0;                                           ///< time by the clock of the log [s]
  double x = 0.0;                                              ///< x of the reference point [m]
  double y = 0.0;                                              ///< y of the reference point [m]
  double psi = 0.0;                                            ///< [rad], not wrapped at π
  double speed = 0.0;                                          ///< [m/s], >= 0
  double yaw_rate = std::numeric_limits<double>::quiet_NaN();  ///< [rad/s]; NaN: not measured
};

/// Command sent to the car, which acts until the next one.
struct SentCommand {
  double time = 0.0;   ///< time of sending [s], by the clock of the samples
  double steer = 0.0;  ///< road-wheel angle [rad], left positive
  double throttle = std::numeric_limits<double>::quiet_NaN();  ///< [-1, 1]; NaN: the log has no pedal
};

/// Log without gaps between the samples. Times increase.
struct DriveLog {
  std::string source;  ///< file, for messages
  std::vector<Sample> samples;
  std::vector<SentCommand> commands;
  bool is_centre_of_mass = false;  ///< the reference point is the centre of mass; else its place is found
  /// Whether the commands have a pedal.
  [[nodiscard]] bool has_throttle() const noexcept {
    return !commands.empty() && commands.front().throttle == commands.front().throttle;
  }
};

/// Options for reading a log.
struct LogOptions {
  std::map<std::string, std::string> columns{};    ///< CSV columns by quantity: {"steer", "cmd_delta_rad"}
  std::map<std::size_t, std::string> positions{};  ///< columns of a CSV file without header: {0, "time_ms"}
  std::string odom_topic{};    ///< topic of the odometry in a bag; empty: the only one of its type
  std::string drive_topic{};   ///< topic of the commands in a bag; empty: the only one of its type
  bool needs_commands = true;  ///< refuses a log without commands
};

/// Reads the log of a file. It may be a recording of this program; a bag of ROS 2 (MCAP or SQLite, file or
/// folder) with nav_msgs/Odometry and ackermann_msgs/AckermannDriveStamped in CDR; or a CSV file with a
/// header. Jumps of the position and half a second without samples divide a log into several.
///
/// CSV columns are found by name, followed by the unit (`_deg`, `_rad`, `_mps`, `_kmh`, `_mph`, `_ms`, `_s`):
/// time, x, y, psi (yaw, heading), speed (v, vx), yaw_rate, steer (steering, delta), throttle (pedal).
///
/// kIo; kParse with file and line for a file that is no log, and for signals that contradict the path:
/// steering in degrees, a speed in another unit, steering or yaw positive to the right.
[[nodiscard]] Result<std::vector<DriveLog>> read_log(const std::string& file, const LogOptions& options);
/// Reads samples and commands of a log in the order of time, without any check or division, to show them.
/// Leaves out values that are not finite. Fails as read_log() does for a file that is no log.
[[nodiscard]] Result<DriveLog> read_plain_log(const std::string& file, const LogOptions& options);
/// Reads logs from the text of a CSV file, as read_log() does; `file`: name for messages.
[[nodiscard]] Result<std::vector<DriveLog>> parse_csv_log(const std::string& text, const std::string& file,
                                                          const LogOptions& options);

}  // namespace chicane::identify
