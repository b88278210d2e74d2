// SPDX-License-Identifier: MIT
// MCAP files: writer with compressed chunks and an index, and a reader that survives damage.
#include "chicane/telemetry/mcap.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "chicane/base/compiler.hpp"

namespace chicane::telemetry::mcap {
namespace {

/// CRC of each byte, by the reflected polynomial 0xedb88320.
constexpr std::array<std::uint32_t, 256> make_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0U ? 0xedb88320U ^ (value >> 1U) : value >> 1U;
    table[i] = value;
  }
  return table;
}

constexpr std::array<std::uint32_t, 256> kTable = make_table();

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far) noexcept {
  std::uint32_t crc = ~so_far;
  for (const char byte : bytes) {
    crc = kTable[(crc ^ static_cast<unsigned char>(byte)) & 0xffU] ^ (crc >> 8U);
  }
  return ~crc;
}

}  // namespace chicane::telemetry::mcap

namespace chicane::telemetry {
namespace {

using mcap::Fields;
using mcap::Opcode;

// Chosen.
constexpr std::size_t kChunkBytes = 1U << 20U;     // [byte] size at which a chunk is written
constexpr std::size_t kMostUnwritten = 4U << 20U;  // [byte] limit of a chunk that cannot be written

/// Bytes of a record.
std::string record(Opcode opcode, std::string_view content) {
  std::string bytes;
  bytes.reserve(mcap::kRecordHead + content.size());
  bytes.push_back(static_cast<char>(opcode));
  Fields(bytes).number(std::uint64_t{content.size()});
  bytes.append(content);
  return bytes;
}

/// Keys and texts as one field.
std::string pairs(const std::map<std::string, std::string>& entries) {
  std::string bytes;
  for (const auto& [key, value] : entries) Fields(bytes).text(key).text(value);
  return bytes;
}

/// Bytes compressed by Zstandard at the fastest level.
std::string compressed_bytes(std::string_view bytes) {
  constexpr int kFastest = 1;
  std::string compressed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), kFastest);
  CHICANE_ASSERT(ZSTD_isError(size) == 0);  // the bound is enough for any input
  compressed.resize(size);
  return compressed;
}

/// Decompressed bytes; none if the input is damaged, or does not yield `size` bytes.
std::optional<std::string> plain_bytes(std::string_view bytes, std::uint64_t size) {
  constexpr std::uint64_t kMost = 256U << 20U;  // chosen: `size` comes from the file, which may be forged
  if (size > kMost) return std::nullopt;
  std::string plain(static_cast<std::size_t>(size), '\0');
  if (ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size()) != plain.size())
    return std::nullopt;
  return plain;
}

Error io_error(const std::string& path, const char* what) {
  return {ErrorCode::kIo, path + ": " + what + ": " + std::strerror(errno)};
}

}  // namespace

Result<std::unique_ptr<McapWriter>> McapWriter::create(const std::string& path, std::string_view library,
                                                       bool is_compressed) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return fail(io_error(path, "cannot make the recording"));
  std::unique_ptr<McapWriter> writer(new McapWriter(path, file, is_compressed));
  std::string header;
  Fields(header).text("ros2").text(library);
  const Result<void> written = writer->put(std::string(mcap::kMagic) + record(Opcode::kHeader, header));
  if (!written) return fail(written.error());
  return writer;
}

McapWriter::~McapWriter() { static_cast<void>(close()); }

Result<void> McapWriter::put(std::string_view bytes) {
  if (!state_) return state_;
  const std::uint64_t size = bytes.size();
  while (!bytes.empty()) {
    const ::ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      Result<void> failed = fail(io_error(path_, "cannot write the recording"));
      const bool is_partial = bytes.size() < size;
      if (is_partial && ::ftruncate(file_, static_cast<::off_t>(position_)) != 0) state_ = failed;
      return failed;
    }
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  position_ += size;
  return {};
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::string_view type,
                                      std::string_view schema) {
  const auto id = static_cast<std::uint16_t>(channels_.size());
  const auto schema_id = static_cast<std::uint16_t>(id + 1);  // 0 means "none"
  std::string content;
  Fields(content).number(schema_id).text(type).text("ros2msg").text(schema);
  Channel channel;
  channel.schema_record = record(Opcode::kSchema, content);
  content.clear();
  Fields(content).number(id).number(schema_id).text(topic).text("cdr").number(std::uint32_t{0});
  channel.record = record(Opcode::kChannel, content);
  chunk_ += channel.schema_record + channel.record;
  channels_.push_back(std::move(channel));
  return id;
}

Result<void> McapWriter::add_metadata(std::string_view name,
                                      const std::map<std::string, std::string>& entries) {
  std::string content;
  Fields(content).text(name).text(pairs(entries));
  const std::string bytes = record(Opcode::kMetadata, content);
  std::string index;
  Fields(index).number(position_).number(std::uint64_t{bytes.size()}).text(name);
  if (Result<void> written = put(bytes); !written) return written;
  metadata_indexes_ += record(Opcode::kMetadataIndex, index);
  ++metadata_;
  return {};
}

Result<void> McapWriter::add_attachment(std::string_view name, std::string_view media_type,
                                        std::string_view bytes) {
  constexpr std::uint64_t kTime = 0;
  std::string content;
  Fields fields(content);
  fields.number(kTime).number(kTime).text(name).text(media_type).number(std::uint64_t{bytes.size()});
  content.append(bytes);
  fields.number(mcap::crc32(content));
  const std::string whole = record(Opcode::kAttachment, content);
  std::string index;
  Fields(index).number(position_).number(std::uint64_t{whole.size()}).number(kTime).number(kTime);
  Fields(index).number(std::uint64_t{bytes.size()}).text(name).text(media_type);
  if (Result<void> written = put(whole); !written) return written;
  attachment_indexes_ += record(Opcode::kAttachmentIndex, index);
  ++attachments_;
  return {};
}

Result<void> McapWriter::write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                               std::string_view bytes) {
  if (!state_) return state_;
  if (chunk_.size() >= kMostUnwritten)
    return fail(ErrorCode::kIo, path_ + ": the recording cannot be written");
  Channel& to = channels_.at(channel);
  to.index.emplace_back(log_time, chunk_.size());
  chunk_.push_back(static_cast<char>(Opcode::kMessage));
  Fields(chunk_).number(std::uint64_t{22 + bytes.size()}).number(channel);
  Fields(chunk_).number(static_cast<std::uint32_t>(to.messages)).number(log_time).number(publish_time);
  chunk_.append(bytes);
  chunk_start_ = chunk_messages_ == 0 ? log_time : std::min(chunk_start_, log_time);
  chunk_end_ = std::max(chunk_end_, log_time);
  start_ = messages_ == 0 ? log_time : std::min(start_, log_time);
  end_ = std::max(end_, log_time);
  ++chunk_messages_;
  ++messages_;
  ++to.messages;
  return chunk_.size() >= kChunkBytes ? flush() : Result<void>{};
}

std::string McapWriter::chunk_records(std::string& index) const {
  std::string content;
  Fields(content).number(chunk_start_).number(chunk_end_).number(std::uint64_t{chunk_.size()});
  const std::string stored = compression_.empty() ? chunk_ : compressed_bytes(chunk_);
  Fields(content).number(mcap::crc32(chunk_)).text(compression_).number(std::uint64_t{stored.size()});
  std::string bytes = record(Opcode::kChunk, content + stored);
  const std::uint64_t chunk_length = bytes.size();

  std::string offsets;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    auto messages = channels_[id].index;
    if (messages.empty()) continue;
    std::sort(messages.begin(), messages.end());
    std::string entries;
    for (const auto& [time, offset] : messages) Fields(entries).number(time).number(offset);
    Fields(offsets).number(static_cast<std::uint16_t>(id)).number(position_ + bytes.size());
    std::string message_index;
    Fields(message_index).number(static_cast<std::uint16_t>(id)).text(entries);
    bytes += record(Opcode::kMessageIndex, message_index);
  }
  Fields(index).number(chunk_start_).number(chunk_end_).number(position_).number(chunk_length);
  Fields(index).text(offsets).number(std::uint64_t{bytes.size() - chunk_length}).text(compression_);
  Fields(index).number(std::uint64_t{stored.size()}).number(std::uint64_t{chunk_.size()});
  return bytes;
}

Result<void> McapWriter::flush() {
  if (chunk_.empty() || !state_) return state_;
  std::string index;
  if (Result<void> written = put(chunk_records(index)); !written) return written;
  for (Channel& channel : channels_) channel.index.clear();
  chunk_.clear();
  chunk_messages_ = chunk_start_ = chunk_end_ = 0;
  chunk_indexes_ += record(Opcode::kChunkIndex, index);
  ++chunks_;
  return {};
}

std::string McapWriter::summary() const {
  std::string schemas, channels, counts, statistics;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    schemas += channels_[id].schema_record;
    channels += channels_[id].record;
    Fields(counts).number(static_cast<std::uint16_t>(id)).number(channels_[id].messages);
  }
  Fields fields(statistics);
  fields.number(messages_).number(static_cast<std::uint16_t>(channels_.size()));
  fields.number(static_cast<std::uint32_t>(channels_.size())).number(attachments_).number(metadata_);
  fields.number(chunks_).number(start_).number(end_).text(counts);

  std::string bytes, offsets;
  const auto group = [&](Opcode opcode, const std::string& records) {
    if (records.empty()) return;
    std::string offset;
    Fields(offset).number(static_cast<unsigned char>(opcode)).number(position_ + bytes.size());
    Fields(offset).number(std::uint64_t{records.size()});
    offsets += record(Opcode::kSummaryOffset, offset);
    bytes += records;
  };
  group(Opcode::kSchema, schemas);
  group(Opcode::kChannel, channels);
  group(Opcode::kStatistics, record(Opcode::kStatistics, statistics));
  group(Opcode::kChunkIndex, chunk_indexes_);
  group(Opcode::kAttachmentIndex, attachment_indexes_);
  group(Opcode::kMetadataIndex, metadata_indexes_);
  const std::uint64_t offsets_start = position_ + bytes.size();
  bytes += offsets;
  bytes.push_back(static_cast<char>(Opcode::kFooter));
  Fields(bytes).number(std::uint64_t{20}).number(position_).number(offsets_start);
  Fields(bytes).number(mcap::crc32(bytes));
  return bytes.append(mcap::kMagic);
}

Result<void> McapWriter::close() {
  if (file_ < 0) return state_;
  std::string no_crc;  // 0: no CRC of the whole file, because every chunk and attachment has one
  Fields(no_crc).number(std::uint32_t{0});
  Result<void> done = flush();
  if (done) done = put(record(Opcode::kDataEnd, no_crc));
  if (done) done = put(summary());
  if (::close(file_) != 0 && done) done = fail(io_error(path_, "cannot close the recording"));
  file_ = -1;
  state_ = done ? fail(ErrorCode::kIo, path_ + ": the recording is closed") : done;
  return done;
}

namespace {

using mcap::FieldReader;
using mcap::Opcode;

// Chosen: sizes in a file may be forged.
constexpr std::uint64_t kMostRecord = 256U << 20U;  // [byte] limit of one record
constexpr std::size_t kMostKept = 64U << 20U;       // [byte] limit of schemas and channels of one file
constexpr std::size_t kMostEntries = 10000;         // limit of the entries of a metadata record

/// Reads a file record by record, and hands intact content to a visitor.
class Reader {
 public:
  Reader(const std::string& path, const McapVisitor& visitor) : path_{path}, visitor_{visitor} {}

  Result<McapReport> read() {
    std::error_code
        error;  // ignored: a missing file fails below. Pipes and devices, which may not end, are refused
    if (std::filesystem::exists(path_, error) && !std::filesystem::is_regular_file(path_, error))
      return fail(ErrorCode::kParse, path_ + ": file: got no file, expected an MCAP file");
    std::ifstream file(path_, std::ios::binary | std::ios::ate);
    if (!file) return fail(ErrorCode::kIo, path_ + ": cannot be read: " + std::strerror(errno));
    std::uint64_t left = static_cast<std::uint64_t>(file.tellg());
    file.seekg(0);
    std::string bytes;
    const auto take = [&](std::uint64_t count) {
      if (count > left || count > kMostRecord) return false;
      bytes.resize(static_cast<std::size_t>(count));
      left -= count;
      return static_cast<bool>(file.read(bytes.data(), static_cast<std::streamsize>(count)));
    };
    if (!take(mcap::kMagic.size()) || bytes != mcap::kMagic) {
      return fail(ErrorCode::kParse, path_ + ": file: got other content, expected an MCAP file");
    }
    while (take(mcap::kRecordHead)) {
      FieldReader head(bytes);
      const auto opcode = static_cast<Opcode>(head.number<unsigned char>());
      if (!take(head.number<std::uint64_t>())) break;
      if (opcode == Opcode::kFooter) {
        report_.is_complete = left == mcap::kMagic.size() && take(left) && bytes == mcap::kMagic;
        break;
      }
      if (is_summary_) continue;  // repeats records from before
      if (Result<void> done = handle(opcode, bytes); !done) return fail(done.error());
    }
    return report_;
  }

 private:
  Result<void> handle(Opcode opcode, std::string_view content) {
    if (opcode == Opcode::kChunk) return chunk(content);
    if (opcode == Opcode::kAttachment) {
      attachment(content);
    } else if (opcode == Opcode::kMetadata) {
      metadata(content);
    } else if (opcode == Opcode::kDataEnd) {
      is_summary_ = true;
    } else if (!in_chunk(opcode, content)) {
      ++report_.damaged;
    }
    return {};
  }

  Result<void> chunk(std::string_view content) {
    FieldReader fields(content);
    static_cast<void>(fields.take(16));  // time span
    const auto size = fields.number<std::uint64_t>();
    const auto crc = fields.number<std::uint32_t>();
    const std::string_view compression = fields.text();
    std::string_view records = fields.take(fields.number<std::uint64_t>());
    if (compression == "lz4")
      return fail(ErrorCode::kParse, path_ + ": chunk: got the compression \"lz4\", expected zstd or none");
    std::optional<std::string> plain;
    if (compression == "zstd") {
      report_.is_compressed = true;
      plain = plain_bytes(records, size);
      if (plain) records = *plain;
    }
    const bool is_unreadable = compression == "zstd" && !plain;
    const bool has_crc_fault = is_unreadable || (crc != 0 && mcap::crc32(records) != crc);
    if (fields.is_short() || has_crc_fault || size != records.size()) {
      ++report_.damaged;
      return {};
    }
    ++report_.chunks;
    FieldReader inner(records);
    while (!inner.rest().empty()) {
      const auto opcode = static_cast<Opcode>(inner.number<unsigned char>());
      const std::string_view part = inner.take(inner.number<std::uint64_t>());
      if (inner.is_short() || !in_chunk(opcode, part)) {
        ++report_.damaged;
        break;
      }
    }
    return {};
  }

  /// Takes a schema, channel or message; ignores other records. False for impossible content.
  bool in_chunk(Opcode opcode, std::string_view content) {
    FieldReader fields(content);
    if (opcode == Opcode::kSchema) {
      const auto id = fields.number<std::uint16_t>();
      const std::string_view name = fields.text();
      static_cast<void>(fields.text());  // encoding
      const std::string_view schema = fields.text();
      auto& known = schemas_[id];
      if (name == known.first && schema == known.second) return !fields.is_short();  // a repetition
      if (!keep(name.size() + schema.size())) return false;
      known = {std::string(name), std::string(schema)};
    } else if (opcode == Opcode::kChannel) {
      const auto id = fields.number<std::uint16_t>();
      const auto& [type, schema] = schemas_[fields.number<std::uint16_t>()];
      const std::string_view topic = fields.text();
      const std::string_view encoding = fields.text();
      if (fields.is_short() || channels_.contains(id)) return !fields.is_short();
      if (!keep(type.size() + schema.size() + topic.size() + encoding.size())) return false;
      channels_.emplace(id, McapChannel{.id = id,
                                        .topic = std::string(topic),
                                        .message_encoding = std::string(encoding),
                                        .type = type,
                                        .schema = schema});
    } else if (opcode == Opcode::kMessage) {
      const auto channel = channels_.find(fields.number<std::uint16_t>());
      const auto sequence = fields.number<std::uint32_t>();
      const auto log_time = fields.number<std::uint64_t>();
      const auto publish_time = fields.number<std::uint64_t>();
      if (fields.is_short() || channel == channels_.end()) return false;
      ++report_.messages;
      if (visitor_.on_message) {
        visitor_.on_message({channel->second, sequence, log_time, publish_time, fields.rest()});
      }
    }
    return !fields.is_short();
  }

  /// Whether `bytes` more may stay in memory. A small file may need much, because channels repeat schemas.
  bool keep(std::size_t bytes) {
    kept_ += bytes;
    return kept_ <= kMostKept;
  }

  void attachment(std::string_view content) {
    FieldReader fields(content);
    static_cast<void>(fields.take(16));  // times
    const std::string_view name = fields.text();
    static_cast<void>(fields.text());  // media type
    const std::string_view bytes = fields.take(fields.number<std::uint64_t>());
    const std::size_t covered = content.size() - fields.rest().size();
    const auto crc = fields.number<std::uint32_t>();
    if (fields.is_short() || (crc != 0 && mcap::crc32(content.substr(0, covered)) != crc)) {
      ++report_.damaged;
    } else if (visitor_.on_attachment) {
      visitor_.on_attachment(name, bytes);
    }
  }

  void metadata(std::string_view content) {
    FieldReader fields(content);
    const std::string_view name = fields.text();
    FieldReader pairs(fields.text());
    std::map<std::string, std::string> entries;
    while (!pairs.rest().empty() && entries.size() <= kMostEntries) {
      std::string key(pairs.text());
      entries[std::move(key)] = std::string(pairs.text());
    }
    if (fields.is_short() || pairs.is_short() || entries.size() > kMostEntries) {
      ++report_.damaged;
    } else if (visitor_.on_metadata) {
      visitor_.on_metadata(name, entries);
    }
  }

  const std::string& path_;
  const McapVisitor& visitor_;
  McapReport report_;
  bool is_summary_ = false;
  std::size_t kept_ = 0;  ///< bytes of schemas and channels
  std::map<std::uint16_t, std::pair<std::string, std::string>> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
};

}  // namespace

Result<McapReport> read_mcap(const std::string& path, const McapVisitor& visitor) {
  return Reader(path, visitor).read();
}

}  // namespace chicane::telemetry
