// SPDX-License-Identifier: MIT
#include "chicane/telemetry/mcap.hpp"

#include "sample_mcap.hpp"
#include "support/chicane_test.hpp"

namespace chicane::telemetry {
namespace {

/// Reads and holds every message against the one that was written.
Result<McapReport> read_and_compare(const std::string& path) {
  return read_mcap(path, {.on_message = [](const McapMessage& message) {
                     EXPECT_EQ(message.bytes, sample_message(message.publish_time));
                   }});
}

TEST(McapReader, ReadsEveryChunkBeforeACutWhereverItIs) {
  const TemporaryFile file;
  const std::vector<std::uint64_t> ends = write_sample(file.path());
  for (std::uint64_t length = std::filesystem::file_size(file.path()) - 1; length >= mcap::kMagic.size();
       --length) {
    std::filesystem::resize_file(file.path(), length);
    const auto report = read_and_compare(file.path());
    ASSERT_TRUE(report) << length;
    std::uint64_t flushed = 0;
    for (const std::uint64_t end : ends) flushed += end <= length ? 1 : 0;
    // The chunk itself may be there while its index is not.
    ASSERT_GE(report->chunks, flushed) << length;
    ASSERT_LE(report->chunks, flushed + 1) << length;
    ASSERT_EQ(report->messages, kSamplePerChunk * report->chunks) << length;
    ASSERT_EQ(report->damaged, 0U) << length;
    ASSERT_FALSE(report->is_complete) << length;
  }
}

TEST(McapReader, LeavesADamagedChunkOutAndGoesOn) {
  const TemporaryFile file;
  const std::vector<std::uint64_t> ends = write_sample(file.path());
  const std::string whole = file.bytes();
  std::string damaged = whole;
  const std::size_t place = damaged.find(sample_message(9));
  ASSERT_GT(place, ends[1]);
  damaged[place] = static_cast<char>(damaged[place] ^ 1);
  file.replace(damaged);
  const auto report = test::good(read_and_compare(file.path()));
  EXPECT_EQ(report->chunks, 4U);
  EXPECT_EQ(report->messages, 16U);
  EXPECT_EQ(report->damaged, 1U);
}

TEST(McapReader, PassesNoDamagedMessageAsGoodWhicheverByteIsWrong) {
  const TemporaryFile file;
  write_sample(file.path());
  const std::string whole = file.bytes();
  std::fstream bytes(file.path(), std::ios::binary | std::ios::in | std::ios::out);
  const auto put = [&](std::size_t place, char value) {
    bytes.seekp(static_cast<std::streamoff>(place));
    bytes.put(value).flush();
  };
  for (std::size_t i = mcap::kMagic.size(); i < whole.size(); ++i) {
    put(i, static_cast<char>(whole[i] ^ 0x10));
    static_cast<void>(read_and_compare(file.path()));
    put(i, whole[i]);
  }
}

TEST(McapReader, LeavesADamagedAttachmentOut) {
  const TemporaryFile file;
  write_sample(file.path());
  std::string damaged = file.bytes();
  damaged[damaged.find("laps: 2")] = 'm';
  file.replace(damaged);
  bool has_attachment = false;
  const auto report = read_mcap(
      file.path(), {.on_attachment = [&](std::string_view, std::string_view) { has_attachment = true; }});
  ASSERT_TRUE(report);
  EXPECT_FALSE(has_attachment);
  EXPECT_EQ(report->damaged, 1U);
}

TEST(McapReader, SaysThatItCannotReadChunksOfOtherCompressions) {
  const TemporaryFile file;
  std::string content;
  mcap::Fields(content).number(std::uint64_t{0}).number(std::uint64_t{0}).number(std::uint64_t{9});
  mcap::Fields(content).number(std::uint32_t{0}).text("lz4").number(std::uint64_t{0});
  std::string bytes = std::string(mcap::kMagic) + static_cast<char>(mcap::Opcode::kChunk);
  mcap::Fields(bytes).number(std::uint64_t{content.size()});
  file.replace(bytes + content);
  EXPECT_THAT(test::refusal_of(read_mcap(file.path(), {})),
              HasSubstr("got the compression \"lz4\", expected "));
}

TEST(McapReader, ReadsCompressedChunksAndPassesNoDamagedOneAsGood) {
  const TemporaryFile file;
  const std::string message(10'000, 'x');
  {
    const auto writer = test::good(McapWriter::create(file.path(), "test", true));
    const std::uint16_t channel = (*writer)->add_channel("/a", "std_msgs/msg/String", "string data\n");
    for (std::uint64_t i = 0; i < 3; ++i) {
      ASSERT_TRUE((*writer)->write(channel, i, i, message));
      ASSERT_TRUE((*writer)->flush());
    }
    ASSERT_TRUE((*writer)->close());
  }
  const std::string bytes = file.bytes();
  EXPECT_LT(bytes.size(), message.size());
  const auto intact = test::good(read_mcap(file.path(), {}));
  EXPECT_EQ(intact->messages, 3U);
  EXPECT_TRUE(intact->is_compressed);
  EXPECT_TRUE(intact->is_complete);
  const std::size_t chunk = bytes.find("\x28\xb5\x2f\xfd");  // a frame of Zstandard begins
  ASSERT_NE(chunk, std::string::npos);
  for (std::size_t i = chunk; i < chunk + 30; ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    file.replace(damaged);
    const auto report = read_mcap(
        file.path(), {.on_message = [&](const McapMessage& read) { EXPECT_EQ(read.bytes, message); }});
    ASSERT_TRUE(report);
    EXPECT_EQ(report->messages + report->damaged, 3U) << i;
  }
}

/// A record with its head.
std::string record(mcap::Opcode opcode, const std::string& content) {
  std::string bytes(1, static_cast<char>(opcode));
  mcap::Fields(bytes).number(std::uint64_t{content.size()});
  return bytes + content;
}

// 6.5 GB asked for by a file of 2 MB.
TEST(McapReader, ASmallFileCannotAskForMuchMemory) {
  std::string schema;
  mcap::Fields(schema).number(std::uint16_t{1}).text("type").text("ros2msg").text(std::string(100'000, 's'));
  std::string bytes = std::string(mcap::kMagic) + record(mcap::Opcode::kSchema, schema);
  constexpr std::uint16_t kChannels = 20'000;
  for (std::uint16_t id = 0; id < kChannels; ++id) {
    std::string channel;
    mcap::Fields(channel).number(id).number(std::uint16_t{1}).text("/t").text("cdr").number(std::uint32_t{0});
    bytes += record(mcap::Opcode::kChannel, channel);
  }
  std::string metadata;
  std::string pairs;
  for (int i = 0; i < 20'000; ++i) mcap::Fields(pairs).text(std::to_string(i)).text("");
  mcap::Fields(metadata).text("many").text(pairs);
  bytes += record(mcap::Opcode::kMetadata, metadata);
  const TemporaryFile file;
  file.replace(bytes);
  bool has_metadata = false;
  const auto report =
      read_mcap(file.path(), {.on_metadata = [&](std::string_view, const auto&) { has_metadata = true; }});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_GT(report->damaged, kChannels - 1000U);  // 64 MiB hold less than a thousand of them
  EXPECT_FALSE(has_metadata);
}

TEST(McapReader, SchemasAndChannelsMayBeRepeatedInEveryChunk) {
  std::string schema;
  mcap::Fields(schema).number(std::uint16_t{1}).text("type").text("ros2msg").text(std::string(100'000, 's'));
  std::string channel;
  mcap::Fields(channel)
      .number(std::uint16_t{1})
      .number(std::uint16_t{1})
      .text("/t")
      .text("cdr")
      .number(std::uint32_t{0});
  std::string bytes{mcap::kMagic};
  for (int i = 0; i < 1000; ++i)
    bytes += record(mcap::Opcode::kSchema, schema) + record(mcap::Opcode::kChannel, channel);
  const TemporaryFile file;
  file.replace(bytes);
  const auto report = test::good(read_mcap(file.path(), {}));
  EXPECT_EQ(report->damaged, 0U);
}

TEST(McapReader, ADeviceIsNoFile) { EXPECT_EQ(read_mcap("/dev/zero", {}).error().code, ErrorCode::kParse); }

TEST(McapReader, RefusesOtherFilesInWords) {
  const TemporaryFile file;
  EXPECT_EQ(read_mcap(file.path(), {}).error().code, ErrorCode::kIo);
  for (const char* content : {"", "MCAP", "x_m,y_m\n1,2\n"}) {
    file.replace(content);
    const auto report = read_mcap(file.path(), {});
    ASSERT_FALSE(report) << content;
    EXPECT_EQ(report.error().code, ErrorCode::kParse);
    EXPECT_THAT(report.error().message, HasSubstr("expected an MCAP file"));
  }
}

}  // namespace
}  // namespace chicane::telemetry
