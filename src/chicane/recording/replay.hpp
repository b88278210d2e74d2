// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "chicane/base/result.hpp"
#include "chicane/run/make.hpp"

namespace chicane::recording {

/// What came of computing a recording's commands again.
struct ReplayReport {
  std::string recorded_by;  ///< program and version
  std::string controller;
  std::string track;
  std::uint64_t steps = 0;      ///< in the file
  std::uint64_t identical = 0;  ///< whose command, rung and gate came out the same, bit for bit
  std::uint64_t different = 0;
  std::uint64_t unknown = 0;                      ///< behind missing steps: their history is not known
  std::optional<std::uint64_t> first_difference;  ///< its cycle
  std::uint64_t late = 0;                         ///< whose deadline was spent; they come out the same, too
  std::uint64_t damaged = 0;                      ///< chunks that were left out
  bool is_complete = false;                       ///< the file was closed as it should be

  [[nodiscard]] bool is_verified() const { return steps > 0 && identical == steps; }
};

/// Builds the controller that a recording describes, or that `make` makes, runs the control cycle with every
/// recorded measurement, and compares what is sent with what was recorded.
///
/// All come out the same, those in real time too: a step whose deadline was spent has recorded which question
/// to the clock said so (base/deadline.hpp), and gets the same answer again. Fails when the file cannot be
/// read, is no recording of ours, or has no step.
[[nodiscard]] Result<ReplayReport> verify_recording(const std::string& path, const run::Factories& make = {});

}  // namespace chicane::recording
