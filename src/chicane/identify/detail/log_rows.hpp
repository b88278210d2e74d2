// SPDX-License-Identifier: MIT
// Readers of logs by format: CSV, MCAP and SQLite. They yield samples and commands as the file has them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/identify/drive_log.hpp"

namespace chicane::identify {

/// Samples and commands of a whole file, in any order of time.
struct LogRows {
  std::vector<Sample> samples;
  std::vector<SentCommand> commands;
  bool is_centre_of_mass = false;  ///< same as in DriveLog
};

/// Reads the text of a CSV file. kParse with `file:line: column: got X, expected Y`.
[[nodiscard]] Result<LogRows> read_csv_rows(const std::string& text, const std::string& file,
                                            const LogOptions& options);
/// Reads an MCAP file: a recording of this program, or messages of ROS 2 in CDR.
[[nodiscard]] Result<LogRows> read_mcap_rows(const std::string& file, const LogOptions& options);
/// Reads a bag of rosbag2 in SQLite (`.db3`) with messages in CDR. Refuses messages over 16 MiB.
[[nodiscard]] Result<LogRows> read_sqlite_rows(const std::string& file, const LogOptions& options);

/// Odometry and commands of a bag of any format, by topic.
class RosRows {
 public:
  /// Adds a message in CDR. Leaves out broken messages, and types other than odometry and commands.
  /// `log_time`: time of recording [ns].
  void add(const std::string& topic, std::string_view type, std::string_view bytes, std::uint64_t log_time);
  /// Rows of the selected topics. kParse if there are none or several.
  [[nodiscard]] Result<LogRows> rows(const std::string& file, const LogOptions& options) const;

 private:
  /// Time since the first message [s]; `stamp`: of the message [ns], 0: none, its `log_time` counts.
  [[nodiscard]] double seconds(std::int64_t stamp, std::uint64_t log_time);

  std::map<std::string, std::vector<Sample>> samples_;        ///< samples by topic
  std::map<std::string, std::vector<SentCommand>> commands_;  ///< commands by topic
  std::optional<std::int64_t> first_;                         ///< time of the first message [ns]
};

}  // namespace chicane::identify
