// SPDX-License-Identifier: MIT
#include "many_runs.hpp"

#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"

namespace chicane::apps {
namespace {

std::string time_left(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

}  // namespace

void keep_memory() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, 1 << 30);
  ::mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

Result<void> check_page_name(std::string_view option, const std::string& file) {
  const std::filesystem::path extension = std::filesystem::path(file).extension();
  std::error_code error;
  const bool is_device =
      std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
  if (file.empty() || extension == ".html" || extension == ".htm" || is_device) return {};
  return fail(refusal(option, file, "a name that ends in .html"));
}

Result<void> write_below(const std::string& page, std::string_view marker, const std::string& text) {
  const std::string older = protocol::read_file(page).value_or("");
  const std::size_t end = older.find(marker);
  const std::string above = end == std::string::npos ? "" : older.substr(0, end);
  return write_file(page, above + std::string(marker) + text);
}

RunCounter::RunCounter(const char* what) : what_{what}, is_terminal_{isatty(STDERR_FILENO) == 1} {
  next_ = started_ + (is_terminal_ ? std::chrono::milliseconds{0} : std::chrono::milliseconds{10000});
}

void RunCounter::show(std::uint64_t done, std::uint64_t runs, std::uint64_t driven) {
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  next_ = now + (is_terminal_ ? std::chrono::milliseconds{200} : std::chrono::milliseconds{10000});
  const double seconds = std::chrono::duration<double>(now - started_).count();
  const double speed = seconds > 0.0 ? static_cast<double>(driven) / seconds : 0.0;
  const std::string left = speed > 0.0 ? time_left(static_cast<double>(runs - done) / speed) : "?";
  fmt::print(stderr, "{}{} of {} {}, {:.1f} a second, {} left{}", is_terminal_ ? "\r" : "", done, runs, what_,
             speed, left, is_terminal_ ? "\x1b[K" : "\n");
  std::fflush(stderr);
  has_line_ = is_terminal_;
}

void RunCounter::end() {
  if (has_line_) fmt::print(stderr, "\n");
  has_line_ = false;
}

}  // namespace chicane::apps
