// SPDX-License-Identifier: MIT
// Files around a recording: the bag's metadata, an indexed copy, temporary files.
#include "chicane/recording/log_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/telemetry/mcap.hpp"

namespace chicane::recording {
namespace {

namespace fs = std::filesystem;

/// Facts of a recording's messages for metadata.yaml.
struct Contents {
  std::map<std::string, std::pair<std::string, std::uint64_t>>
      topics{};  ///< type and number of messages by name
  std::uint64_t messages = 0;
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();  ///< [ns]
  std::uint64_t last = 0;                                           ///< [ns]
};

Result<Contents> contents_of(const std::string& recording) {
  Contents contents;
  const auto read =
      telemetry::read_mcap(recording, {.on_message = [&](const telemetry::McapMessage& message) {
                             if (message.channel.message_encoding != "cdr") return;
                             auto& [type, count] = contents.topics[message.channel.topic];
                             type = message.channel.type;
                             ++count;
                             ++contents.messages;
                             contents.first = std::min(contents.first, message.log_time);
                             contents.last = std::max(contents.last, message.log_time);
                           }});
  if (!read) return fail(read.error());
  contents.first = std::min(contents.first, contents.last);
  return contents;
}

std::string as_yaml(const Contents& contents, const std::string& file) {
  const std::uint64_t duration = contents.last - contents.first;
  std::string text = fmt::format(
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
      "  duration:\n    nanoseconds: {}\n  starting_time:\n    nanoseconds_since_epoch: {}\n"
      "  message_count: {}\n  topics_with_message_count:\n",
      duration, contents.first, contents.messages);
  for (const auto& [topic, what] : contents.topics) {
    text += fmt::format(
        "    - topic_metadata:\n        name: {}\n        type: {}\n        serialization_format: cdr\n"
        "        offered_qos_profiles: \"\"\n      message_count: {}\n",
        topic, what.first, what.second);
  }
  text += fmt::format(
      "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - \"{0}\"\n  "
      "files:\n"
      "    - path: \"{0}\"\n      starting_time:\n        nanoseconds_since_epoch: {1}\n"
      "      duration:\n        nanoseconds: {2}\n      message_count: {3}\n",
      file, contents.first, duration, contents.messages);
  return text;
}

std::string name_of(const std::string& recording) { return fs::path(recording).filename().string(); }

}  // namespace

std::string bag_metadata_path(const std::string& recording) {
  return (fs::path(recording).parent_path() / "metadata.yaml").string();
}

Result<void> can_be_bag(const std::string& recording) {
  const std::string path = bag_metadata_path(recording);
  const Result<std::string> before = protocol::read_file(path);
  if (!before || before->find("\"" + name_of(recording) + "\"") != std::string::npos) return {};
  return fail(
      ErrorCode::kInvalidArgument,
      fmt::format("--bag: got a folder with the bag of another recording ({}), expected one of its own",
                  path));
}

Result<void> write_bag_metadata(const std::string& recording) {
  const Result<Contents> contents = contents_of(recording);
  if (!contents) return fail(contents.error());
  return write_file(bag_metadata_path(recording), as_yaml(*contents, name_of(recording)));
}

Result<telemetry::McapReport> indexed_copy(const std::string& from, const std::string& to) {
  const auto writer = telemetry::McapWriter::create(to, "chicane");
  if (!writer) return fail(writer.error());
  std::map<std::uint16_t, std::uint16_t> channels;  // channels of the copy by channels of the recording
  Result<void> state;
  const auto keep = [&](Result<void> done) {
    if (state && !done) state = std::move(done);
  };
  const auto read = telemetry::read_mcap(
      from,
      {.on_message =
           [&](const telemetry::McapMessage& message) {
             const telemetry::McapChannel& channel = message.channel;
             const auto [place, is_new] = channels.try_emplace(channel.id);
             if (is_new) place->second = (*writer)->add_channel(channel.topic, channel.type, channel.schema);
             keep((*writer)->write(place->second, message.log_time, message.publish_time, message.bytes));
           },
       .on_attachment =
           [&](std::string_view name, std::string_view bytes) {
             keep((*writer)->add_attachment(name, "application/yaml", bytes));
           },
       .on_metadata = [&](std::string_view name,
                          const auto& entries) { keep((*writer)->add_metadata(name, entries)); }});
  if (!read) return fail(read.error());
  keep((*writer)->close());
  if (!state) return fail(state.error());
  return *read;
}

TemporaryFile::TemporaryFile(std::string_view extension) {
  static std::atomic<unsigned> number{0};
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) folder = ".";
  path_ = (folder / fmt::format("chicane-{}-{}{}", ::getpid(), number++, extension)).string();
  std::filesystem::remove(path_, error);  // left by a killed process with the same number
}

TemporaryFile::~TemporaryFile() {
  std::error_code error;
  std::filesystem::remove(path_, error);
}

}  // namespace chicane::recording
