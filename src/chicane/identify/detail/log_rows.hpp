// SPDX-License-Identifier: MIT
#pragma once

#include <string>
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

}  // namespace chicane::identify
