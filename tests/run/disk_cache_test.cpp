// SPDX-License-Identifier: MIT
#include "chicane/run/disk_cache.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace chicane::run {
namespace {

namespace fs = std::filesystem;

class DiskCacheTest : public testing::Test {
 protected:
  DiskCacheTest()
      : folder_{fs::temp_directory_path() / ("chicane-cache-" + std::to_string(::getpid()) + "-" +
                                             testing::UnitTest::GetInstance()->current_test_info()->name())} {
    fs::remove_all(folder_);
  }
  ~DiskCacheTest() override { fs::remove_all(folder_); }

  [[nodiscard]] DiskCache cache(std::uint64_t most = DiskCache::kMostBytes) {
    return DiskCache(
        folder_.string(), [this](std::string_view line) { said_.emplace_back(line); }, most);
  }
  [[nodiscard]] fs::path file(std::string_view name) const {
    return folder_ / (std::string(name) + ".cache");
  }

  fs::path folder_;
  std::vector<std::string> said_;
};

TEST_F(DiskCacheTest, GivesBackWhatWasKept) {
  const std::string bytes("a\0b", 3);
  EXPECT_FALSE(cache().find("11"));
  cache().keep("11", bytes);
  EXPECT_EQ(cache().find("11"), bytes);
  EXPECT_FALSE(cache().find("12"));
  EXPECT_TRUE(said_.empty());
}

TEST_F(DiskCacheTest, ADamagedFileIsIgnoredWithOneLine) {
  cache().keep("11", std::string(1000, 'x'));
  const auto damage = [&](auto how) {
    cache().keep("11", std::string(1000, 'x'));
    how();
    said_.clear();
    EXPECT_FALSE(cache().find("11"));
    ASSERT_EQ(said_.size(), 1U);
    EXPECT_NE(said_[0].find("is damaged and ignored"), std::string::npos) << said_[0];
    EXPECT_NE(said_[0].find(file("11").string()), std::string::npos) << said_[0];
  };
  damage([&] { fs::resize_file(file("11"), 500); });
  damage([&] { fs::resize_file(file("11"), 0); });
  damage([&] {
    std::fstream stream(file("11"), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(700);
    stream.put('y');
  });
  damage([&] { std::ofstream(file("11")) << "something else"; });
  cache().keep("11", "new");
  EXPECT_EQ(cache().find("11"), "new");
}

TEST_F(DiskCacheTest, RemovesWhatWasUnusedForLongest) {
  const std::string bytes(1000, 'x');
  const DiskCache small = cache(2500);
  const auto used = [&](std::string_view name, int minutes_ago) {
    fs::last_write_time(file(name), fs::file_time_type::clock::now() - std::chrono::minutes(minutes_ago));
  };
  small.keep("1a", bytes);
  small.keep("2b", bytes);
  used("1a", 30);
  used("2b", 20);
  EXPECT_TRUE(small.find("1a")) << "now 2b is the one unused for longest";
  small.keep("3c", bytes);
  EXPECT_TRUE(fs::exists(file("1a")));
  EXPECT_FALSE(fs::exists(file("2b")));
  EXPECT_TRUE(fs::exists(file("3c")));
}

TEST_F(DiskCacheTest, KeepsABoundedNumberOfFiles) {
  fs::create_directories(folder_);
  for (std::size_t i = 0; i < DiskCache::kMostFiles + 20; ++i) std::ofstream(file(std::to_string(i))) << "x";
  cache().keep("abc", "x");
  EXPECT_EQ(cache().find("abc"), "x");
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(folder_)) ++count;
  EXPECT_EQ(count, DiskCache::kMostFiles);
}

TEST_F(DiskCacheTest, TwoProcessesAndAKillLeaveWholeFiles) {
  const std::string bytes(200000, 'x');
  std::vector<pid_t> children;
  for (int child = 0; child < 2; ++child) {
    const pid_t id = ::fork();
    if (id == 0) {
      const DiskCache ours(folder_.string());
      for (;;) ours.keep("11", bytes);
    }
    children.push_back(id);
  }
  int seen = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (seen < 200 && std::chrono::steady_clock::now() < end) {
    const auto found = cache().find("11");
    if (!found) continue;
    EXPECT_EQ(*found, bytes);
    ++seen;
  }
  for (const pid_t id : children) {
    ::kill(id, SIGKILL);
    ::waitpid(id, nullptr, 0);
  }
  EXPECT_EQ(seen, 200);
  EXPECT_TRUE(said_.empty()) << said_.front();
  EXPECT_EQ(cache().find("11"), bytes) << "after the kill";
}

TEST_F(DiskCacheTest, RemovesWhatAKilledProcessLeft) {
  cache().keep("11", "x");
  const fs::path old = folder_ / "22.cache.1-0.part";
  const fs::path recent = folder_ / "22.cache.2-0.part";
  std::ofstream(old) << "half";
  std::ofstream(recent) << "half";
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(2));
  cache().keep("11", "x");
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(recent)) << "another process may be writing it";
}

TEST_F(DiskCacheTest, AFolderThatCannotBeMadeCostsNothingButTime) {
  const DiskCache nowhere("/dev/null/chicane");
  nowhere.keep("11", "x");
  EXPECT_FALSE(nowhere.find("11"));
}

TEST_F(DiskCacheTest, StandsWhereTheUsersCachesAre) {
  const auto with = [](const char* cache, const char* home) {
    const char* old_cache = std::getenv("XDG_CACHE_HOME");
    const char* old_home = std::getenv("HOME");
    const std::string kept_cache = old_cache != nullptr ? old_cache : "";
    const std::string kept_home = old_home != nullptr ? old_home : "";
    ::setenv("XDG_CACHE_HOME", cache, 1);
    ::setenv("HOME", home, 1);
    const std::string folder = DiskCache::default_folder();
    ::setenv("XDG_CACHE_HOME", kept_cache.c_str(), 1);
    ::setenv("HOME", kept_home.c_str(), 1);
    return folder;
  };
  EXPECT_EQ(with("/var/c", "/home/me"), "/var/c/chicane");
  EXPECT_EQ(with("", "/home/me"), "/home/me/.cache/chicane");
  EXPECT_EQ(with("relative", "/home/me"), "/home/me/.cache/chicane");
  EXPECT_EQ(with("", ""), "");
}

}  // namespace
}  // namespace chicane::run
