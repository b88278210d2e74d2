// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

namespace chicane::telemetry {

struct McapChannel {
  std::uint16_t id = 0;
  std::string topic;
  std::string message_encoding;
  std::string type;  ///< name of its schema; empty without one
  std::string schema;
};

/// Views are valid during the call only.
struct McapMessage {
  const McapChannel& channel;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;      ///< [ns]
  std::uint64_t publish_time = 0;  ///< [ns]
  std::string_view bytes;
};

/// Called in the order of the file. Any of them may be empty.
struct McapVisitor {
  std::function<void(const McapMessage&)> on_message{};
  std::function<void(std::string_view name, std::string_view bytes)> on_attachment{};
  std::function<void(std::string_view name, const std::map<std::string, std::string>&)> on_metadata{};
};

/// How much of a file there was.
struct McapReport {
  std::uint64_t messages = 0;
  std::uint64_t chunks = 0;   ///< intact ones
  std::uint64_t damaged = 0;  ///< chunks and attachments that were left out: wrong CRC or content
  bool is_compressed = false;
  bool is_complete = false;  ///< closed as it should be; otherwise the writer was killed, or the end is lost
};

/// Reads every intact record of an MCAP file, whether or not it was closed: from front to back, without its
/// index. What ends in the middle of a record, and chunks whose CRC is wrong, are left out and counted; a
/// wrong length between records ends the reading. Memory: one chunk (at most 256 MiB), and at most 64 MiB of
/// schemas and channels; those beyond count as damaged.
///
/// kIo when it cannot be read; kParse when it is no MCAP file, or is compressed by other means than
/// Zstandard, or by that when this program was built without it.
[[nodiscard]] Result<McapReport> read_mcap(const std::string& path, const McapVisitor& visitor);

}  // namespace chicane::telemetry
