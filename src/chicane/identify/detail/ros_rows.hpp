// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/identify/detail/log_rows.hpp"

namespace chicane::identify {

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
