// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

/// Logs of driving: a car's positions and the commands sent to it, without the program that drove it.
namespace chicane::identify {

/// Measured pose of the car, in axes with x forward, y left and yaw positive to the left (docs/notation.md).
struct Sample {
  double time = 0.0;                                           ///< [s]
  double x = 0.0;                                              ///< x of the reference point [m]
  double y = 0.0;                                              ///< [m]
  double psi = 0.0;                                            ///< [rad], not wrapped at π
  double speed = 0.0;                                          ///< [m/s], >= 0
  double yaw_rate = std::numeric_limits<double>::quiet_NaN();  ///< [rad/s]; NaN: not measured
};

/// Command sent to the car; acts until the next one.
struct SentCommand {
  double time = 0.0;   ///< time of sending [s], by the clock of the samples
  double steer = 0.0;  ///< road-wheel angle [rad], left positive
  double throttle = std::numeric_limits<double>::quiet_NaN();  ///< [-1, 1]; NaN: the log has no pedal
};

/// A log without gaps in its place: times increase.
struct DriveLog {
  std::string source;  ///< file, for messages
  std::vector<Sample> samples;
  std::vector<SentCommand> commands;
  bool is_centre_of_mass = false;  ///< the reference point is the centre of mass; else its place is found
  [[nodiscard]] bool has_throttle() const noexcept {
    return !commands.empty() && commands.front().throttle == commands.front().throttle;
  }
};

/// Options for reading a log.
struct LogOptions {
  std::map<std::string, std::string> columns{};    ///< names of a CSV file: {"steer", "cmd_delta_rad"}
  std::map<std::size_t, std::string> positions{};  ///< by column from 0, without a header: {0, "time_ms"}
  std::string odom_topic{};    ///< odometry in a foreign MCAP file; empty: the only one of its type
  std::string drive_topic{};   ///< the same
  bool needs_commands = true;  ///< false: a log of the car alone is one, too
};

/// Reads recordings of ours, bags of ROS 2 (MCAP, SQLite) with nav_msgs/Odometry and
/// ackermann_msgs/AckermannDriveStamped in CDR, as a file or its folder, and CSV files with a header. Jumps
/// and half a second without samples divide a log into several.
///
/// CSV columns are found by name, with their unit behind (`_deg`, `_rad`, `_mps`, `_kmh`, `_mph`, `_ms`,
/// `_s`): time, x, y, psi (yaw, heading), speed (v, vx), yaw_rate, steer (steering, delta), throttle (pedal).
///
/// kIo; kParse with file and line for a file that is no log, and for values that contradict their column:
/// steering in degrees, a speed in other units than the path, steering or yaw positive to the right.
[[nodiscard]] Result<std::vector<DriveLog>> read_log(const std::string& file, const LogOptions& options);
/// The samples and commands of a log in the order of time, as they are: for showing them. Values that are not
/// finite are left out; without `needs_commands` there may be no commands.
[[nodiscard]] Result<DriveLog> read_plain_log(const std::string& file, const LogOptions& options);
/// Logs from the text of a CSV file; `file` is for messages.
[[nodiscard]] Result<std::vector<DriveLog>> parse_csv_log(const std::string& text, const std::string& file,
                                                          const LogOptions& options);

}  // namespace chicane::identify
