// SPDX-License-Identifier: MIT
// What a recording does to a run when the disk stalls or is full: nothing.
#include <fcntl.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "chicane/recording/recorder.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using telemetry::TemporaryFile;

/// From now on whatever is open as `path` in this process, but for `except`, writes to `target` instead.
void redirect(const std::string& path, int except, int target) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    if (entry.path().filename() == std::to_string(except)) continue;
    if (std::filesystem::read_symlink(entry.path(), error) != path || error) continue;
    ASSERT_GE(::dup2(target, std::stoi(entry.path().filename())), 0);
    return;
  }
  FAIL() << path << " is not open";
}

class SlowDisk : public testing::Test {
 protected:
  SlowDisk() {
    loop_ = test::loop_of(test::scenario_of({{"controller", "pid"}}));
    path_ = std::filesystem::weakly_canonical(file_.path()).string();
    const auto say = [this](std::string_view line) {
      const std::lock_guard lock(mutex_);
      said_.emplace_back(line);
      has_said_.notify_all();
    };
    auto made = Recorder::create({.path = path_, .run = {}, .scenario = loop_->scenario(), .say = say});
    recorder_ = std::move(*test::good(std::move(made)));
  }
  void drive(int cycles) {
    test::drive_cycles(*loop_, cycles, [this](const telemetry::Frame& frame) { recorder_->record(frame); });
  }

  /// What the recorder has said, when that are `count` sentences.
  std::vector<std::string> said(std::size_t count) {
    std::unique_lock lock(mutex_);
    has_said_.wait_for(lock, std::chrono::seconds{30}, [&] { return said_.size() >= count; });
    return said_;
  }

  std::mutex mutex_;
  std::condition_variable has_said_;
  std::vector<std::string> said_;
  TemporaryFile file_;
  std::string path_;
  std::unique_ptr<run::ClosedLoop> loop_;
  std::unique_ptr<Recorder> recorder_;
};

TEST_F(SlowDisk, ThatStandsStillHoldsNobodyUpIsReportedAndLosesFramesBeforeItLosesAChange) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  redirect(path_, -1, ends[1]);
  ::close(ends[1]);
  // Nobody reads the pipe: the writing thread stands still in write() after 64 KiB. If the run waited for it,
  // the next line would never end.
  drive(2000);
  recorder_->record(telemetry::Change{.cycle = 2000, .time = 80.0, .name = "latency_ms", .value = "50"});
  std::string bytes;
  std::thread reader([&] {  // the disk works again
    std::array<char, 65536> some{};
    for (::ssize_t count = 0; (count = ::read(ends[0], some.data(), some.size())) > 0;)
      bytes.append(some.data(), static_cast<std::size_t>(count));
  });
  const Result<RecorderReport> report = recorder_->finish();
  reader.join();
  ::close(ends[0]);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->frames + report->left_out, 2000U);
  EXPECT_GT(report->left_out, 1000U);
  EXPECT_GT(report->frames, 60U) << "what was buffered is written when the disk works again";
  EXPECT_GT(bytes.size(), 64U * 1024U);
  EXPECT_THAT(bytes, HasSubstr("latency_ms"));
}

TEST_F(SlowDisk, ThatIsFullHoldsNobodyUpAndIsNamedAtTheEnd) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  redirect(path_, -1, full);
  ::close(full);
  drive(2000);
  const Result<RecorderReport> report = recorder_->finish();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kIo);
  EXPECT_THAT(report.error().message, HasSubstr("No space left on device"));
}

TEST_F(SlowDisk, ThatIsFullForAWhileIsNamedAtOnceAndGoesOnWhenThereIsRoom) {
  const int disk = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(disk, 0);
  ASSERT_GE(full, 0);
  drive(20);
  redirect(path_, disk, full);
  drive(20);
  ASSERT_EQ(said(1).size(), 1U);
  EXPECT_THAT(said(1)[0], HasSubstr("No space left on device; trying again, steps until then"));
  recorder_->record(telemetry::Change{.cycle = 40, .time = 1.6, .name = "latency_ms", .value = "50"});
  drive(1000);
  redirect("/dev/full", full, disk);
  ::close(full);
  const std::vector<std::string> told = said(2);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_THAT(told[1], HasSubstr(": can be written again; "));
  drive(20);
  const Result<RecorderReport> report = recorder_->finish();
  ::close(disk);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_GT(report->missing, 100U);
  EXPECT_GE(report->frames, 40U);
  EXPECT_EQ(report->frames + report->left_out + report->missing, 1060U);
  std::uint64_t steps = 0, changes = 0;
  const auto read = telemetry::read_mcap(path_, {.on_message = [&](const telemetry::McapMessage& message) {
                                           steps += message.channel.topic == "/chicane/step" ? 1 : 0;
                                           changes += message.channel.topic == "/chicane/change" ? 1 : 0;
                                         }});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->damaged, 0U);
  EXPECT_TRUE(read->is_complete);
  EXPECT_EQ(steps, report->frames);
  EXPECT_EQ(changes, 1U);
}

}  // namespace
}  // namespace chicane::recording
