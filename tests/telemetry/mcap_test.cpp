// SPDX-License-Identifier: MIT
#include "chicane/telemetry/mcap.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <csignal>

#include "sample_mcap.hpp"
#include "support/chicane_test.hpp"

namespace chicane::telemetry {
namespace {

TEST(McapFormat, ChecksumIsThatOfIeee8023) {
  EXPECT_EQ(mcap::crc32(""), 0u);
  EXPECT_EQ(mcap::crc32("123456789"), 0xcbf43926u);  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(mcap::crc32("6789", mcap::crc32("12345")), mcap::crc32("123456789"));
}

TEST(McapFormat, NumbersAreLittleEndianAndTextsHaveTheirLengthInFront) {
  std::string bytes;
  mcap::Fields{bytes}.number(std::uint16_t{0x1234}).text("ab");
  EXPECT_EQ(bytes, std::string("\x34\x12\x02\0\0\0ab", 8));
}

TEST(McapFormat, ReadsWhatItWrote) {
  std::string bytes;
  mcap::Fields{bytes}.number(std::uint64_t{1} << 63).text("").text("topic").number(std::uint8_t{7});
  mcap::FieldReader reader{bytes};
  EXPECT_EQ(reader.number<std::uint64_t>(), std::uint64_t{1} << 63);
  EXPECT_EQ(reader.text(), "");
  EXPECT_EQ(reader.text(), "topic");
  EXPECT_EQ(reader.rest().size(), 1u);
  EXPECT_EQ(reader.number<std::uint8_t>(), 7);
  EXPECT_FALSE(reader.is_short());
}

TEST(McapFormat, ReadsZerosForEverAfterAnEndThatCameTooEarly) {
  mcap::FieldReader reader{std::string_view("\x05\0\0\0abc\x01", 8)};
  EXPECT_EQ(reader.text(), "") << "five bytes announced, four there";
  EXPECT_TRUE(reader.is_short());
  EXPECT_EQ(reader.number<std::uint8_t>(), 0);
  EXPECT_TRUE(reader.is_short());
}

TEST(McapWriter, WritesWhatTheReaderReads) {
  const TemporaryFile file;
  write_sample(file.path());
  std::uint64_t number = 0;
  std::string seen;
  const auto report = read_mcap(
      file.path(),
      {.on_message =
           [&](const McapMessage& message) {
             EXPECT_EQ(message.channel.topic, number % 2 == 0 ? "/a" : "/b");
             EXPECT_EQ(message.channel.type, number % 2 == 0 ? "std_msgs/msg/String" : "std_msgs/msg/Bool");
             EXPECT_EQ(message.channel.schema, number % 2 == 0 ? "string data\n" : "bool data\n");
             EXPECT_EQ(message.channel.message_encoding, "cdr");
             EXPECT_EQ(message.sequence, number / 2);
             EXPECT_EQ(message.log_time, 1000 * number);
             EXPECT_EQ(message.publish_time, number);
             EXPECT_EQ(message.bytes, sample_message(number));
             ++number;
           },
       .on_attachment = [&](std::string_view name,
                            std::string_view bytes) { seen += std::string(name) + "=" + std::string(bytes); },
       .on_metadata =
           [&](std::string_view name, const auto& entries) {
             seen += std::string(name) + ":" + entries.at("seed") + entries.at("track") + ";";
           }});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(number, 20U);
  EXPECT_EQ(report->messages, 20U);
  EXPECT_EQ(report->chunks, 5U);
  EXPECT_EQ(report->damaged, 0U);
  EXPECT_TRUE(report->is_complete);
  EXPECT_EQ(seen, "run:7lakeside;notes.txt=laps: 2\n");
}

TEST(McapWriter, EndsAChunkThatIsLargeWithoutBeingAsked) {
  const TemporaryFile file;
  const auto writer = test::good(McapWriter::create(file.path(), "test"));
  const std::uint16_t channel = (*writer)->add_channel("/a", "t", "");
  const std::string half(600U << 10U, 'x');
  ASSERT_TRUE((*writer)->write(channel, 0, 0, half));
  EXPECT_LT((*writer)->bytes_written(), 1000U);
  ASSERT_TRUE((*writer)->write(channel, 1, 1, half));
  EXPECT_GT((*writer)->bytes_written(), 1200U << 10U);
}

TEST(McapWriter, NeverWritesOverARecording) {
  const TemporaryFile file;
  file.replace("precious");
  const auto writer = McapWriter::create(file.path(), "test");
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.error().code, ErrorCode::kIo);
  EXPECT_THAT(writer.error().message, HasSubstr("exists"));
  EXPECT_EQ(file.bytes(), "precious");
}

/// In a child, whose files may have `limit` bytes from now on: that stands for the full disk, with writes of
/// which a part fits.
template <class Run>
void with_little_room(Run run) {
  const ::pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::_exit(run([](::rlim_t limit) {
      const ::rlimit soft{limit, RLIM_INFINITY};
      ::setrlimit(RLIMIT_FSIZE, &soft);
    })
                ? 0
                : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(McapWriter, SaysTheSameErrorAgainOnAFullDisk) {
  const TemporaryFile file;
  with_little_room([&](auto limit) {
    limit(4096);
    const auto writer = McapWriter::create(file.path(), "test");
    const std::uint16_t channel = (*writer)->add_channel("/a", "t", "");
    bool is_right = (*writer)->write(channel, 0, 0, std::string(8192, 'x')).has_value();
    const Result<void> first = (*writer)->flush();
    const Result<void> second = (*writer)->flush();
    const Result<void> third = (*writer)->close();
    is_right = is_right && !first && !second && !third && first.error().message == third.error().message;
    return is_right && !(*writer)->write(channel, 1, 1, "y");
  });
}

TEST(McapWriter, TakesBackWhatFitsOnlyInPartAndGoesOnWhenThereIsRoom) {
  for (const ::rlim_t room : {2000U, 4096U, 4097U, 9000U, 17000U}) {
    const TemporaryFile file;
    with_little_room([&](auto limit) {
      const auto writer = McapWriter::create(file.path(), "test");
      const std::uint16_t channel = (*writer)->add_channel("/a", "t", "");
      bool is_right = (*writer)->flush().has_value();
      limit(room);
      int failures = 0;
      for (std::uint64_t i = 0; i < 4; ++i) {
        is_right = is_right && (*writer)->write(channel, i, i, std::string(5000, 'x'));
        if (!(*writer)->flush()) ++failures;
      }
      if (!(*writer)->add_metadata("late", {{"a", std::string(5000, 'b')}})) ++failures;
      limit(RLIM_INFINITY);
      return is_right && failures > 0 && (*writer)->close();
    });
    const auto report = test::good(read_mcap(file.path(), {}));
    EXPECT_EQ(report->messages, 4U) << room;
    EXPECT_EQ(report->damaged, 0U) << room;
    EXPECT_TRUE(report->is_complete) << room;
  }
}

TEST(McapWriter, HoldsFourMebibytesAtMostWhileTheDiskIsFull) {
  const TemporaryFile file;
  with_little_room([&](auto limit) {
    limit(4096);
    const auto writer = McapWriter::create(file.path(), "test");
    const std::uint16_t channel = (*writer)->add_channel("/a", "t", "");
    for (std::uint64_t i = 0; i < 1000; ++i)
      static_cast<void>((*writer)->write(channel, i, i, std::string(100'000, 'x')));
    limit(RLIM_INFINITY);
    return (*writer)->close().has_value() && (*writer)->bytes_written() < 4'400'000;
  });
}

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

/// A schema of 100 kB, and a channel of it.
std::string large_schema() {
  std::string schema;
  mcap::Fields(schema).number(std::uint16_t{1}).text("type").text("ros2msg").text(std::string(100'000, 's'));
  return record(mcap::Opcode::kSchema, schema);
}
std::string channel_of_it(std::uint16_t id) {
  std::string channel;
  mcap::Fields(channel).number(id).number(std::uint16_t{1}).text("/t").text("cdr").number(std::uint32_t{0});
  return record(mcap::Opcode::kChannel, channel);
}

// 6.5 GB asked for by a file of 2 MB.
TEST(McapReader, ASmallFileCannotAskForMuchMemory) {
  std::string bytes = std::string(mcap::kMagic) + large_schema();
  constexpr std::uint16_t kChannels = 20'000;
  for (std::uint16_t id = 0; id < kChannels; ++id) bytes += channel_of_it(id);
  std::string metadata;
  std::string pairs;
  for (int i = 0; i < 20'000; ++i) mcap::Fields(pairs).text(std::to_string(i)).text("");
  mcap::Fields(metadata).text("many").text(pairs);
  bytes += record(mcap::Opcode::kMetadata, metadata);
  const TemporaryFile file;
  file.replace(bytes);
  bool has_metadata = false;
  const auto report = test::good(
      read_mcap(file.path(), {.on_metadata = [&](std::string_view, const auto&) { has_metadata = true; }}));
  EXPECT_GT(report->damaged, kChannels - 1000U);  // 64 MiB hold less than a thousand of them
  EXPECT_FALSE(has_metadata);
}

TEST(McapReader, SchemasAndChannelsMayBeRepeatedInEveryChunk) {
  std::string bytes{mcap::kMagic};
  for (int i = 0; i < 1000; ++i) bytes += large_schema() + channel_of_it(1);
  const TemporaryFile file;
  file.replace(bytes);
  EXPECT_EQ(test::good(read_mcap(file.path(), {}))->damaged, 0U);
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
