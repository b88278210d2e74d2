// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/telemetry/mcap.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::telemetry {

/// A path where nothing is yet; removed at the end.
class TemporaryFile {
 public:
  [[nodiscard]] std::string path() const { return folder_.path(kName); }
  [[nodiscard]] std::string bytes() const { return folder_.content(kName); }
  void replace(const std::string& bytes) const { folder_.write(kName, bytes); }

 private:
  static constexpr const char* kName = "run.mcap";
  test::Folder folder_;
};

/// Message `number` of the sample: its bytes depend on the number alone.
inline std::string sample_message(std::uint64_t number) {
  return std::string(40 + number % 7, static_cast<char>('a' + number % 26)) + std::to_string(number);
}

constexpr int kSampleChunks = 5;
constexpr int kSamplePerChunk = 4;

/// Two channels, an attachment, metadata; five chunks of four messages. Where each flush ended.
inline std::vector<std::uint64_t> write_sample(const std::string& path) {
  const auto writer = McapWriter::create(path, "chicane test");
  EXPECT_TRUE(writer.has_value());
  std::vector<std::uint64_t> ends;
  EXPECT_TRUE((*writer)->add_metadata("run", {{"seed", "7"}, {"track", "lakeside"}}));
  EXPECT_TRUE((*writer)->add_attachment("notes.txt", "text/plain", "laps: 2\n"));
  const std::uint16_t first = (*writer)->add_channel("/a", "std_msgs/msg/String", "string data\n");
  const std::uint16_t second = (*writer)->add_channel("/b", "std_msgs/msg/Bool", "bool data\n");
  std::uint64_t number = 0;
  for (int chunk = 0; chunk < kSampleChunks; ++chunk) {
    for (int i = 0; i < kSamplePerChunk; ++i, ++number) {
      EXPECT_TRUE(
          (*writer)->write(i % 2 == 0 ? first : second, 1000 * number, number, sample_message(number)));
    }
    EXPECT_TRUE((*writer)->flush());
    ends.push_back((*writer)->bytes_written());
  }
  EXPECT_TRUE((*writer)->close());
  return ends;
}

}  // namespace chicane::telemetry
