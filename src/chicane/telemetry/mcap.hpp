// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"

/// Format that writer and reader of MCAP files share (https://mcap.dev/spec, version 1): numbers are little
/// endian, strings are preceded by their 32-bit length, records by one byte for their kind and their 64-bit
/// length.

namespace chicane::telemetry::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t kRecordHead = 9;  ///< bytes before a record's content

enum class Opcode : unsigned char {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

/// CRC-32 of IEEE 802.3, as zlib computes it; `so_far` continues an earlier one.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0) noexcept;

/// Appends fields to a buffer.
class Fields {
 public:
  explicit Fields(std::string& bytes) : bytes_{bytes} {}
  template <class T>
  Fields& number(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xffU));
    }
    return *this;
  }
  Fields& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_.append(value);
    return *this;
  }

 private:
  std::string& bytes_;
};

/// Takes fields from the front of bytes that may end too early: then is_short() for ever, and zeros.
class FieldReader {
 public:
  explicit FieldReader(std::string_view bytes) : rest_{bytes} {}
  template <class T>
  [[nodiscard]] T number() {
    std::uint64_t value = 0;
    const std::string_view bytes = take(sizeof(T));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    }
    return static_cast<T>(value);
  }
  [[nodiscard]] std::string_view text() { return take(number<std::uint32_t>()); }
  [[nodiscard]] std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) {
      is_short_ = true;
      rest_ = {};
      return {};
    }
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[nodiscard]] bool is_short() const { return is_short_; }

 private:
  std::string_view rest_;
  bool is_short_ = false;
};

}  // namespace chicane::telemetry::mcap

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
  /// Creates a file. kIo if it exists already or cannot be made: a recording is never overwritten.
  /// `is_compressed`: chunks by Zstandard.
  [[nodiscard]] static Result<std::unique_ptr<McapWriter>> create(const std::string& path,
                                                                  std::string_view library,
                                                                  bool is_compressed = false);
  /// Closes, if close() was not called; errors are then not reported.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// A stream of CDR messages of a ROS 2 type; its number, from 0. `schema` is in the form of "ros2msg".
  std::uint16_t add_channel(std::string_view topic, std::string_view type, std::string_view schema);
  /// Writes keys and texts about the file's content; at once in the file.
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
    std::string record;  ///< record for the summary
    std::string schema_record;
    std::uint64_t messages = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  ///< index of this chunk: log time, offset
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

/// Extent of a file that was read.
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
/// Zstandard.
[[nodiscard]] Result<McapReport> read_mcap(const std::string& path, const McapVisitor& visitor);

}  // namespace chicane::telemetry
