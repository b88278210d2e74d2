// SPDX-License-Identifier: MIT
#include "chicane/telemetry/mcap_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "chicane/telemetry/detail/zstd.hpp"

namespace chicane::telemetry {
namespace {

using mcap::Fields;
using mcap::Opcode;

constexpr std::size_t kChunkBytes = 1U << 20U;
constexpr std::size_t kMostBytes = 4U << 20U;  // of a chunk that cannot be written

std::string record(Opcode opcode, std::string_view content) {
  std::string bytes;
  bytes.reserve(mcap::kRecordHead + content.size());
  bytes.push_back(static_cast<char>(opcode));
  Fields(bytes).number(std::uint64_t{content.size()});
  bytes.append(content);
  return bytes;
}

std::string pairs(const std::map<std::string, std::string>& entries) {
  std::string bytes;
  for (const auto& [key, value] : entries) Fields(bytes).text(key).text(value);
  return bytes;
}

Error io_error(const std::string& path, const char* what) {
  return {ErrorCode::kIo, path + ": " + what + ": " + std::strerror(errno)};
}

}  // namespace

Result<std::unique_ptr<McapWriter>> McapWriter::create(const std::string& path, std::string_view library,
                                                       bool is_compressed) {
  if (is_compressed && !zstd::is_available()) {
    return fail(ErrorCode::kInvalidArgument, path +
                                                 ": got a compressed recording to write, expected a program "
                                                 "built with libzstd (Debian: libzstd-dev)");
  }
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

/// All of it or nothing.
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
  if (chunk_.size() >= kMostBytes) return fail(ErrorCode::kIo, path_ + ": the recording cannot be written");
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

/// The chunk and the indexes of its messages, as they are in the file at position_; and its record for the
/// summary.
std::string McapWriter::chunk_records(std::string& index) const {
  std::string content;
  Fields(content).number(chunk_start_).number(chunk_end_).number(std::uint64_t{chunk_.size()});
  const std::string stored = compression_.empty() ? chunk_ : zstd::compress(chunk_);
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

/// Everything from the summary to the end of the file, which begins at position_.
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
  std::string no_crc;  // every chunk and attachment has its own
  Fields(no_crc).number(std::uint32_t{0});
  Result<void> done = flush();
  if (done) done = put(record(Opcode::kDataEnd, no_crc));
  if (done) done = put(summary());
  if (::close(file_) != 0 && done) done = fail(io_error(path_, "cannot close the recording"));
  file_ = -1;
  state_ = done ? fail(ErrorCode::kIo, path_ + ": the recording is closed") : done;
  return done;
}

}  // namespace chicane::telemetry
