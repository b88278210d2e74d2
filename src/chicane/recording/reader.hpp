// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "chicane/base/result.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/change.hpp"
#include "chicane/telemetry/mcap_reader.hpp"

namespace chicane::recording {

/// Of the messages that are shown, one for each control step.
inline constexpr std::string_view kFrameTopic = "/chicane/frame";

/// A control step and where it lies on the recording's time line.
struct RecordedStep {
  protocol::Step step;
  double log_time = 0.0;  ///< [s]
};

/// What is needed to compute a recording again, in its order: a scenario begins a run.
using RecordedEvent = std::variant<scenario::Scenario, telemetry::Change, RecordedStep>;

/// Who recorded a run, of what.
struct RecordingHead {
  std::map<std::string, std::string, std::less<>> entries{};  ///< metadata "run", docs/recording.md
  [[nodiscard]] std::string operator[](const std::string& key) const {
    const auto entry = entries.find(key);
    return entry == entries.end() ? "" : entry->second;
  }
};

/// Reads the events of a recording, one after the other; a failure of the visitor ends the reading. Chooses
/// the arithmetic that the recording was made with (base/instruction_set.hpp). Damaged messages count as
/// damaged.
///
/// kParse for what is no recording of ours; kInvalidArgument for one of `simulate`, whose commands came from
/// another program, and for one whose arithmetic this processor has not.
[[nodiscard]] Result<telemetry::McapReport> read_recording(
    const std::string& path, RecordingHead& head,
    const std::function<Result<void>(const RecordedEvent&)>& visit);

/// The scenario of the first run in a recording of `drive`; the failures of read_recording(), and
/// kInvalidArgument for a recording of `serve`, whose car is not here to drive on.
[[nodiscard]] Result<scenario::Scenario> recorded_scenario(const std::string& path);

/// Whether a file is a log of another program: a CSV table, a bag of SQLite or a bag's folder by its name, an
/// MCAP file by its topics, odometry in CDR and no control step of ours.
[[nodiscard]] bool is_foreign_log(const std::string& file);

/// Whether a file can be shown: how much of it there is. Also kParse "x.mcap: got no control step, expected a
/// recording of ours, or …" for bags of other programs, and for a recording cut before its first step is
/// whole.
[[nodiscard]] Result<telemetry::McapReport> check_recording(const std::string& path);

}  // namespace chicane::recording
