// SPDX-License-Identifier: MIT
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

/// Samples and commands of a whole file in any order, as one reader of a format found them.
struct LogRows {
  std::vector<Sample> samples;
  std::vector<SentCommand> commands;
  bool is_centre_of_mass = false;
};

/// A CSV file with a header. kParse with `file:line: column: got X, expected Y`.
[[nodiscard]] Result<LogRows> read_csv_rows(const std::string& text, const std::string& file,
                                            const LogOptions& options);
/// An MCAP file: of ours, or with messages of ROS 2 in CDR.
[[nodiscard]] Result<LogRows> read_mcap_rows(const std::string& file, const LogOptions& options);
/// A bag of rosbag2 in SQLite (`.db3`), with messages in CDR. Messages over 16 MiB are refused.
[[nodiscard]] Result<LogRows> read_sqlite_rows(const std::string& file, const LogOptions& options);

/// Collects the odometry and the commands of a bag, whatever holds it, by topic.
class RosRows {
 public:
  /// A message in CDR; others than odometry and commands are left out, broken ones too.
  void add(const std::string& topic, std::string_view type, std::string_view bytes, std::uint64_t log_time);
  /// Rows of the selected topics. kParse if there are none or several.
  [[nodiscard]] Result<LogRows> rows(const std::string& file, const LogOptions& options) const;

 private:
  /// [s] after the first message; a message without a stamp counts when it was logged.
  [[nodiscard]] double seconds(std::int64_t stamp, std::uint64_t log_time);

  std::map<std::string, std::vector<Sample>> samples_;  ///< samples by topic
  std::map<std::string, std::vector<SentCommand>> commands_;
  std::optional<std::int64_t> first_;
};

}  // namespace chicane::identify
