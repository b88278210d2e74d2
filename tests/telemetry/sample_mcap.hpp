// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "chicane/telemetry/mcap.hpp"

namespace chicane::telemetry {

/// A path in the folder for temporary files where nothing is yet; removed at the end.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '_');
    path_ = std::filesystem::path(::testing::TempDir()) / (name + std::to_string(::getpid()) + ".mcap");
    std::filesystem::remove(path_);
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::string bytes() const {
    std::ostringstream text;
    text << std::ifstream(path_, std::ios::binary).rdbuf();
    return text.str();
  }
  void replace(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }

 private:
  std::filesystem::path path_;
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
