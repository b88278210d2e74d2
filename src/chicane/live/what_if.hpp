// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/live/worker.hpp"
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
  /// What stood in for a car that others simulate.
  struct StandIn {
    std::string plant;      ///< of ours
    double compared = 0.0;  ///< so long before the moment both drove from the same place [s]; 0: not compared
    double apart = 0.0;     ///< and came so far from each other [m]
  };
  struct Answer {
    recording::BranchReport report{};
    std::optional<StandIn> stand_in{};
    Answer() = default;
    Answer(recording::BranchReport told) : report{std::move(told)} {}  // NOLINT(*-explicit-*)
  };
  /// Computes a question; called on the other thread. `hooks` are handed on to recording::branch_run().
  using Compute =
      std::function<Result<Answer>(const WhatIfQuestion& question, const recording::BranchHooks& hooks)>;

  explicit WhatIf(Compute compute);
  /// Gives up what is being computed.
  ~WhatIf();
  WhatIf(const WhatIf&) = delete;
  WhatIf& operator=(const WhatIf&) = delete;

  /// Begins, and does not wait; the number of the question, as a text.
  [[nodiscard]] Result<std::string> ask(std::string_view json);
  /// The newest answer, or how far it is: GET /what_if.json (docs/viewer_laps.md).
  [[nodiscard]] std::string answer();

 private:
  void work();
  [[nodiscard]] std::string computed(std::uint64_t number, const WhatIfQuestion& question);

  Compute compute_;
  std::atomic<std::uint64_t> newest_{
      0};                           ///< number of the last question; the one being computed may be older
  std::atomic<double> share_{0.0};  ///< of it that is computed
  std::mutex mutex_;                ///< of all below
  std::optional<WhatIfQuestion> wish_;
  std::string answer_ = R"({"id":0,"state":"none"})";
  std::uint64_t answered_ = 0;
  Worker worker_;  // last
};

}  // namespace chicane::live
