// SPDX-License-Identifier: MIT
// MCAP files: the records of the format, a writer, and a reader that survives damage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"

/// Format of MCAP files (https://mcap.dev/spec, version 1): numbers are little endian; a string follows its
/// 32-bit length; a record follows one byte for its kind and its 64-bit length.
namespace chicane::telemetry::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};  ///< first and last bytes of a file
inline constexpr std::size_t kRecordHead = 9;                  ///< bytes before a record's content

/// Kinds of records.
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

/// CRC-32 of IEEE 802.3, as zlib computes it; `so_far`: CRC of the bytes before, 0 without any.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0) noexcept;

/// Appends fields to a buffer, which it refers to.
class Fields {
 public:
  explicit Fields(std::string& bytes) : bytes_{bytes} {}
  /// Appends an integer of the type's size.
  template <class T>
  Fields& number(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xffU));
    }
    return *this;
  }
  /// Appends a text after its length.
  Fields& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_.append(value);
    return *this;
  }

 private:
  std::string& bytes_;
};

/// Takes fields from the front of bytes. If the bytes end too early, is_short() is true from then on, and all
/// fields are zero or empty.
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
  /// Next `count` bytes.
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

/// Writer of an MCAP file (https://mcap.dev/spec, version 1, profile "ros2"): chunks with CRC, message
/// indexes, and at the end the summary by which readers seek. Written bytes never change: a process that is
/// killed leaves all chunks up to its last flush(), which read_mcap() can read.
///
/// A record that cannot be written, as on a full disk, is removed again, so that the file ends with an intact
/// record. Its chunk is kept, and the next flush() tries again. If the removal fails as well, every further
/// call fails with the same error.
///
/// Memory: one chunk, and about 300 bytes of index for each written chunk. One thread.
class McapWriter {
 public:
  /// Creates a file. kIo if it cannot be made or exists already: a recording is never overwritten. `library`:
  /// name of the writing program. `is_compressed`: compresses chunks by Zstandard.
  [[nodiscard]] static Result<std::unique_ptr<McapWriter>> create(const std::string& path,
                                                                  std::string_view library,
                                                                  bool is_compressed = false);
  /// Closes, if close() was not called; errors are then not reported.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Adds a stream of CDR messages of a ROS 2 type, and returns its number, from 0. `schema` is a definition
  /// in the form "ros2msg".
  std::uint16_t add_channel(std::string_view topic, std::string_view type, std::string_view schema);
  /// Writes keys and texts about the content to the file, without a chunk.
  Result<void> add_metadata(std::string_view name, const std::map<std::string, std::string>& entries);
  /// Writes the content of another file to the file, with its own CRC, without a chunk.
  Result<void> add_attachment(std::string_view name, std::string_view media_type, std::string_view bytes);
  /// Adds a message to the chunk. `log_time` [ns] should not fall; `publish_time` [ns] may. Writes the chunk
  /// at 1 MiB. While that fails the chunk grows up to 4 MiB; beyond, messages are refused.
  Result<void> write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                     std::string_view bytes);
  /// Writes the chunk to the file, where it survives the end of the process.
  Result<void> flush();
  /// Writes the last chunk, the summary and the end. Nothing can be written afterwards.
  Result<void> close();

  [[nodiscard]] std::uint64_t bytes_written() const noexcept { return position_; }

 private:
  /// Stream of messages.
  struct Channel {
    std::string record;          ///< its record, repeated in the summary
    std::string schema_record;   ///< record of its schema, repeated in the summary
    std::uint64_t messages = 0;  ///< messages so far
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  ///< log time and offset in the current chunk
  };

  McapWriter(std::string path, int file, bool is_compressed)
      : path_{std::move(path)}, file_{file}, compression_{is_compressed ? "zstd" : ""} {}
  /// Writes all bytes to the file, or none of them.
  Result<void> put(std::string_view bytes);
  /// Records of the chunk and of its message indexes, as they are in the file at position_. Fills `index`,
  /// the chunk's entry in the summary.
  [[nodiscard]] std::string chunk_records(std::string& index) const;
  /// Bytes from the summary, at position_, to the end of the file.
  [[nodiscard]] std::string summary() const;

  std::string path_;
  int file_ = -1;                                                      ///< descriptor; -1: closed
  std::string_view compression_;                                       ///< "zstd" or empty
  Result<void> state_;                                                 ///< error of every further call
  std::uint64_t position_ = 0;                                         ///< size of the file [byte]
  std::vector<Channel> channels_;                                      ///< channels by number
  std::string chunk_;                                                  ///< records of the current chunk
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;                      ///< log times of its messages [ns]
  std::uint64_t chunk_messages_ = 0;                                   ///< messages in it
  std::uint64_t start_ = 0, end_ = 0, messages_ = 0;                   ///< log times and messages of the file
  std::string chunk_indexes_, attachment_indexes_, metadata_indexes_;  ///< records for the summary
  std::uint32_t chunks_ = 0, attachments_ = 0, metadata_ = 0;          ///< records in the file
};

/// Stream of messages in a file.
struct McapChannel {
  std::uint16_t id = 0;
  std::string topic;
  std::string message_encoding;  ///< "cdr" for messages of ROS 2
  std::string type;              ///< name of its schema; empty without one
  std::string schema;            ///< definition of the type
};

/// Message in a file. Views are valid during the call only.
struct McapMessage {
  const McapChannel& channel;
  std::uint32_t sequence = 0;      ///< number in its channel
  std::uint64_t log_time = 0;      ///< time of recording [ns]
  std::uint64_t publish_time = 0;  ///< time of sending [ns]
  std::string_view bytes;          ///< content
};

/// Functions that read_mcap() calls in the order of the file; each may be empty.
struct McapVisitor {
  std::function<void(const McapMessage&)> on_message{};
  std::function<void(std::string_view name, std::string_view bytes)> on_attachment{};
  std::function<void(std::string_view name, const std::map<std::string, std::string>&)> on_metadata{};
};

/// Extent of a file that was read.
struct McapReport {
  std::uint64_t messages = 0;  ///< messages read
  std::uint64_t chunks = 0;    ///< intact chunks
  std::uint64_t damaged = 0;   ///< chunks and records left out because of a wrong CRC or content
  bool is_compressed = false;  ///< a chunk is compressed by Zstandard
  bool is_complete = false;    ///< the file was closed; false: the writer was killed, or the end is lost
};

/// Reads every intact record of an MCAP file from front to back, without its index, closed or not. Leaves out
/// and counts chunks with a wrong CRC; a wrong length between records ends the reading. Memory: one chunk (at
/// most 256 MiB), and at most 64 MiB of schemas and channels; those beyond count as damaged.
///
/// kIo when the file cannot be read; kParse when it is no MCAP file, or is compressed by other means than
/// Zstandard.
[[nodiscard]] Result<McapReport> read_mcap(const std::string& path, const McapVisitor& visitor);

}  // namespace chicane::telemetry
