// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

namespace chicane::apps {

/// Each run takes some megabytes and gives them back: the process keeps them for the next one.
void keep_memory();

/// Checks that the name of an HTML page is one that browsers open: `option`: got x.txt, expected a name that
/// ends in .html. An empty name is no file; devices may have any.
[[nodiscard]] Result<void> check_page_name(std::string_view option, const std::string& file);

/// Replaces what a page has behind `marker`; a page without one is replaced. kIo.
[[nodiscard]] Result<void> write_below(const std::string& page, std::string_view marker,
                                       const std::string& text);

/// Tells on stderr how many of many runs are done, how fast, and how long the rest will take: on a terminal
/// one line that renews itself, otherwise a line every ten seconds. One thread at a time.
class RunCounter {
 public:
  /// `what`: the word for what is counted.
  explicit RunCounter(const char* what = "runs");
  /// `driven`: of the `done` ones since the start, for the speed.
  void show(std::uint64_t done, std::uint64_t runs, std::uint64_t driven);
  /// Leaves the cursor at the beginning of a line.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  const char* what_;
  bool is_terminal_;
  bool has_line_ = false;
  Clock::time_point started_ = Clock::now();
  Clock::time_point next_;
};

}  // namespace chicane::apps
