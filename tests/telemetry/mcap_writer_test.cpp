// SPDX-License-Identifier: MIT
#include "chicane/telemetry/mcap.hpp"

#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>

#include "sample_mcap.hpp"
#include "support/chicane_test.hpp"

namespace chicane::telemetry {
namespace {

TEST(McapWriter, ComputesTheCrcOfTheStandard) {
  EXPECT_EQ(mcap::crc32("123456789"), 0xcbf43926U);  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(mcap::crc32("6789", mcap::crc32("12345")), 0xcbf43926U);
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

TEST(McapWriter, LosesNothingThatWasFlushedWhenItIsKilled) {
  for (int round = 0; round < 20; ++round) {
    const TemporaryFile file;
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    const ::pid_t child = ::fork();
    if (child == 0) {  // tells the number of each message that was flushed, until it is killed
      const auto writer = McapWriter::create(file.path(), "test");
      const std::uint16_t channel = (*writer)->add_channel("/a", "t", "");
      for (std::uint64_t number = 0;; ++number) {
        static_cast<void>((*writer)->write(channel, number, number, sample_message(number)));
        if (number % 3 != 2) continue;
        static_cast<void>((*writer)->flush());
        if (::write(ends[1], &number, sizeof number) < 0) ::_exit(1);
      }
    }
    ::close(ends[1]);
    std::uint64_t last = 0;
    for (int i = 0; i < 20 + 7 * round; ++i) ASSERT_EQ(::read(ends[0], &last, sizeof last), 8);
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    while (::read(ends[0], &last, sizeof last) == 8) {
    }
    ::close(ends[0]);

    std::uint64_t number = 0;
    const auto report = read_mcap(file.path(), {.on_message = [&](const McapMessage& message) {
                                    EXPECT_EQ(message.bytes, sample_message(number));
                                    ++number;
                                  }});
    ASSERT_TRUE(report);
    EXPECT_GT(number, last);
    EXPECT_EQ(report->damaged, 0U);
    EXPECT_FALSE(report->is_complete);
  }
}

}  // namespace
}  // namespace chicane::telemetry
