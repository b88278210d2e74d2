// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/telemetry/mcap_format.hpp"

namespace chicane::telemetry {

/// Writes an MCAP file (https://mcap.dev/spec, version 1, profile "ros2"): chunks with CRC, message indexes,
/// and at the end the summary that readers seek by. Nothing that is in the file is ever touched again: a
/// process that is killed leaves all chunks up to its last flush(), and read_mcap() reads them.
///
/// Memory: one chunk, and about 300 bytes for each chunk written (the index). One thread.
///
/// What cannot be written (a full disk) is taken back, so that the file ends behind an intact record, and the
/// chunk is kept: the next flush() tries again. Where taking back fails, too, every further call fails in the
/// same words.
class McapWriter {
 public:
  /// kIo when the file exists already or cannot be made: a recording is never written over. `is_compressed`:
  /// chunks by Zstandard; kInvalidArgument when this program was built without it.
  [[nodiscard]] static Result<std::unique_ptr<McapWriter>> create(const std::string& path,
                                                                  std::string_view library,
                                                                  bool is_compressed = false);
  /// Closes, if close() was not called; errors are then not reported.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// A stream of CDR messages of a ROS 2 type; its number, from 0. `schema` is in the form of "ros2msg".
  std::uint16_t add_channel(std::string_view topic, std::string_view type, std::string_view schema);
  /// Keys and texts that say what the file is about; at once in the file.
  Result<void> add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);
  /// A file in the file, with a CRC of its own; at once in the file.
  Result<void> add_attachment(std::string_view name, std::string_view media_type, std::string_view bytes);
  /// `log_time` [ns] should not go back; `publish_time` [ns] may. Ends the chunk when it has 1 MiB; while
  /// that fails it grows, up to 4 MiB, and then the message is refused.
  Result<void> write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                     std::string_view bytes);
  /// Ends the chunk and writes it to the file: from here on it survives the end of the process.
  Result<void> flush();
  /// The last chunk, the summary and the end. Nothing can be written afterwards.
  Result<void> close();

  [[nodiscard]] std::uint64_t bytes_written() const noexcept { return position_; }

 private:
  struct Channel {
    std::string record;  ///< for the summary
    std::string schema_record;
    std::uint64_t messages = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  ///< of this chunk: log time, offset
  };

  McapWriter(std::string path, int file, bool is_compressed)
      : path_{std::move(path)}, file_{file}, compression_{is_compressed ? "zstd" : ""} {}
  Result<void> put(std::string_view bytes);
  [[nodiscard]] std::string chunk_records(std::string& index) const;
  [[nodiscard]] std::string summary() const;

  std::string path_;
  int file_ = -1;
  std::string_view compression_;
  Result<void> state_;
  std::uint64_t position_ = 0;
  std::vector<Channel> channels_;
  std::string chunk_;
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;  ///< log times of its messages
  std::uint64_t chunk_messages_ = 0;
  std::uint64_t start_ = 0, end_ = 0, messages_ = 0;
  std::string chunk_indexes_, attachment_indexes_, metadata_indexes_;  ///< records of the summary
  std::uint32_t chunks_ = 0, attachments_ = 0, metadata_ = 0;
};

}  // namespace chicane::telemetry
