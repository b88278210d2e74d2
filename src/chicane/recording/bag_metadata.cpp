// SPDX-License-Identifier: MIT
#include "chicane/recording/bag_metadata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/telemetry/mcap_reader.hpp"

namespace chicane::recording {
namespace {

namespace fs = std::filesystem;

/// What metadata.yaml says of the messages in a recording.
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

}  // namespace chicane::recording
