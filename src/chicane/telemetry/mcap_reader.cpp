// SPDX-License-Identifier: MIT
#include "chicane/telemetry/mcap_reader.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include "chicane/telemetry/detail/zstd.hpp"
#include "chicane/telemetry/mcap_format.hpp"

namespace chicane::telemetry {
namespace {

using mcap::FieldReader;
using mcap::Opcode;

constexpr std::uint64_t kMostBytes = 256U << 20U;  // of one record
constexpr std::size_t kMostKept = 64U << 20U;  // of schemas and channels, as long as a file is read [byte]
constexpr std::size_t kMostEntries = 10000;    // of one metadata record

class Reader {
 public:
  Reader(const std::string& path, const McapVisitor& visitor) : path_{path}, visitor_{visitor} {}

  Result<McapReport> read() {
    std::error_code error;  // a pipe or a device would not end
    if (std::filesystem::exists(path_, error) && !std::filesystem::is_regular_file(path_, error))
      return fail(ErrorCode::kParse, path_ + ": file: got no file, expected an MCAP file");
    std::ifstream file(path_, std::ios::binary | std::ios::ate);
    if (!file) return fail(ErrorCode::kIo, path_ + ": cannot be read: " + std::strerror(errno));
    std::uint64_t left = static_cast<std::uint64_t>(file.tellg());
    file.seekg(0);
    std::string bytes;
    const auto take = [&](std::uint64_t count) {
      if (count > left || count > kMostBytes) return false;
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
      if (is_summary_) continue;  // says everything a second time
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
    static_cast<void>(fields.take(16));  // its time span
    const auto size = fields.number<std::uint64_t>();
    const auto crc = fields.number<std::uint32_t>();
    const std::string_view compression = fields.text();
    std::string_view records = fields.take(fields.number<std::uint64_t>());
    if (compression == "lz4" || (compression == "zstd" && !zstd::is_available())) {
      return fail(ErrorCode::kParse,
                  path_ + ": chunk: got the compression \"" + std::string(compression) + "\", expected " +
                      (zstd::is_available() ? "zstd or none" : "none (built without libzstd)"));
    }
    std::optional<std::string> plain;
    if (compression == "zstd") {
      report_.is_compressed = true;
      plain = zstd::decompress(records, size);
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

  /// Schemas, channels and messages; others are passed over. False for content that cannot be.
  bool in_chunk(Opcode opcode, std::string_view content) {
    FieldReader fields(content);
    if (opcode == Opcode::kSchema) {
      const auto id = fields.number<std::uint16_t>();
      const std::string_view name = fields.text();
      static_cast<void>(fields.text());  // encoding
      const std::string_view schema = fields.text();
      auto& known = schemas_[id];
      if (name == known.first && schema == known.second) return !fields.is_short();  // repeated
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

  /// Whether so much more may stay in memory: a small file can ask for much, as channels repeat schemas.
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
  std::size_t kept_ = 0;  ///< of schemas and channels [byte]
  std::map<std::uint16_t, std::pair<std::string, std::string>> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
};

}  // namespace

Result<McapReport> read_mcap(const std::string& path, const McapVisitor& visitor) {
  return Reader(path, visitor).read();
}

}  // namespace chicane::telemetry
