// SPDX-License-Identifier: MIT
#include "chicane/base/file.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace chicane {
namespace {

class Files : public testing::Test, protected test::Folder {
 protected:
  [[nodiscard]] std::ptrdiff_t count() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }
};

using test::refusal_of;

/// As `ulimit -f` does it, while it is there.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : before_{::signal(SIGXFSZ, SIG_IGN)} {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    ::signal(SIGXFSZ, before_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  sighandler_t before_;
  rlimit old_{};
};

TEST_F(Files, AreMadeReplacedAndNothingIsLeftBesideThem) {
  EXPECT_TRUE(write_file(path("a"), "one"));
  EXPECT_EQ(content("a"), "one");
  EXPECT_TRUE(write_file(path("a"), ""));
  EXPECT_EQ(content("a"), "");
  EXPECT_EQ(count(), 1);
}

TEST_F(Files, StayWholeWhenTheNewContentIsTooLong) {
  ASSERT_TRUE(write_file(path("a"), "old"));
  {
    const FileSizeLimit limit(1024);
    EXPECT_EQ(refusal_of(write_file(path("a"), std::string(5000, 'x'))),
              path("a") + ": cannot be written: File too large");
    EXPECT_TRUE(check_writable(path("a")));
  }
  EXPECT_EQ(content("a"), "old");
  EXPECT_EQ(count(), 1);
}

TEST_F(Files, StayWholeUntilTheWriterHasFinished) {
  ASSERT_TRUE(write_file(path("a"), "old"));
  {
    FileWriter abandoned(path("a"));
    abandoned.write("new");
    EXPECT_TRUE(abandoned.check());
  }
  EXPECT_EQ(content("a"), "old");
  FileWriter writer(path("a"));
  writer.write("ne");
  writer.write("w");
  EXPECT_EQ(content("a"), "old");
  EXPECT_TRUE(writer.finish());
  EXPECT_EQ(content("a"), "new");
  EXPECT_EQ(count(), 1);
}

TEST_F(Files, KeepTheirPermissionsAndTheirLinks) {
  ASSERT_TRUE(write_file(path("a"), "old"));
  fs::permissions(path("a"), fs::perms(0640));
  fs::create_symlink("a", path("link"));
  EXPECT_TRUE(write_file(path("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content("a"), "new");
  EXPECT_EQ(fs::status(path("a")).permissions(), fs::perms(0640));
  EXPECT_TRUE(write_file(path("secret"), "x", 0600));
  EXPECT_EQ(fs::status(path("secret")).permissions(), fs::perms(0600));
}

TEST_F(Files, SayInOneSentenceWhyTheyCannotBeWritten) {
  const std::string nowhere = path("no/such/a");
  EXPECT_EQ(refusal_of(write_file(nowhere, "x")), nowhere + ": cannot be written: No such file or directory");
  EXPECT_EQ(refusal_of(check_writable(nowhere)), nowhere + ": cannot be written: No such file or directory");
  EXPECT_EQ(refusal_of(write_file(folder_.string(), "x")),
            folder_.string() + ": cannot be written: Is a directory");
  EXPECT_EQ(refusal_of(check_writable(folder_.string())),
            folder_.string() + ": cannot be written: Is a directory");
  EXPECT_EQ(refusal_of(write_file("/dev/full", "x")),
            "/dev/full: cannot be written: No space left on device");
  EXPECT_EQ(write_file("/dev/full", "x").error().code, ErrorCode::kIo);
}

TEST_F(Files, OfOthersAreNotReplaced) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everything";
  ASSERT_TRUE(write_file(path("a"), "old"));
  fs::permissions(path("a"), fs::perms(0444));
  EXPECT_EQ(refusal_of(write_file(path("a"), "new")), path("a") + ": cannot be written: Permission denied");
  fs::permissions(path("a"), fs::perms(0644));
  fs::permissions(folder_, fs::perms(0555));
  EXPECT_TRUE(write_file(path("a"), "new")) << "its folder takes no new file: written in place";
  fs::permissions(folder_, fs::perms(0755));
  EXPECT_EQ(content("a"), "new");
}

TEST_F(Files, PipesAndDevicesAreWrittenThrough) {
  EXPECT_TRUE(write_file("/dev/null", "x"));
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_TRUE(check_writable(path("pipe"))) << "without a reader";
  std::string got;
  std::thread reader([&] { got = content("pipe"); });
  EXPECT_TRUE(write_file(path("pipe"), "through"));
  reader.join();
  EXPECT_EQ(got, "through");
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(Files, ChecksLeaveNothing) {
  EXPECT_TRUE(check_writable(""));
  EXPECT_TRUE(check_writable(path("new")));
  EXPECT_EQ(count(), 0);
}

}  // namespace
}  // namespace chicane
