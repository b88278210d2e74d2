// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/live/newest_task.hpp"
#include "chicane/recording/branch.hpp"

namespace chicane::live {

/// "What if" of a run: from a moment on, with other settings.
struct WhatIfQuestion {
  std::size_t log = 0;                       ///< which of several recordings; 0 in a live run
  recording::BranchOptions options{};        ///< `drives_both`: what was, or would be, beside it
  static constexpr double kLongest = 600.0;  ///< [s] of each future
  static constexpr std::size_t kMostSettings = 64;
};

/// Reads {"at_s":12.5,"for_s":20,"laps":1,"log":0,"settings":{"latency_ms":60}}. `at_s` null or absent: from
/// now on; `laps`: the line is crossed so often, whatever is reached first. kInvalidArgument in a sentence
/// for viewers.
[[nodiscard]] Result<WhatIfQuestion> read_question(std::string_view json);

/// Answers one question at a time, by computing the run again and driving both futures, on a thread of its
/// own with low priority: control never waits. A new question takes the place of the one before. ask() and
/// answer() are one thread's, the network thread.
class WhatIf {
 public:
  /// Computes a question; called on the other thread. `hooks` are handed on to recording::branch_run().
  using Compute = std::function<Result<recording::BranchReport>(const WhatIfQuestion& question,
                                                                const recording::BranchHooks& hooks)>;

  explicit WhatIf(Compute compute);

  /// Begins, and does not wait; the number of the question, as a text.
  [[nodiscard]] Result<std::string> ask(std::string_view json);
  /// The newest answer, or how far it is: GET /what_if.json (docs/viewer_laps.md).
  [[nodiscard]] std::string answer();

 private:
  struct Request {
    std::uint64_t number = 0;
    WhatIfQuestion question;
  };
  [[nodiscard]] std::string computed(const Request& request, const std::function<bool()>& is_wanted);

  Compute compute_;
  std::uint64_t newest_ = 0;        ///< number of the last question
  std::atomic<double> share_{0.0};  ///< of the question that is being computed
  std::string answer_ = R"({"id":0,"state":"none"})";
  NewestTask<Request, std::string> task_;  // last
};

}  // namespace chicane::live
