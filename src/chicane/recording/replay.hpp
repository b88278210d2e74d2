// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "chicane/base/result.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/run/make.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::recording {

/// Topic of the shown messages, one for each control step.
inline constexpr std::string_view kFrameTopic = "/chicane/frame";

/// A control step and where it lies on the recording's time line.
struct RecordedStep {
  protocol::Step step;
  double log_time = 0.0;  ///< [s]
};

/// Event needed to compute a recording again, in recorded order: a scenario begins a run.
using RecordedEvent = std::variant<scenario::Scenario, telemetry::Change, RecordedStep>;

/// Program and scenario behind a recording.
struct RecordingHead {
  std::map<std::string, std::string, std::less<>> entries{};  ///< metadata "run", docs/viewer.md#recordings
  [[nodiscard]] std::string operator[](const std::string& key) const {
    const auto entry = entries.find(key);
    return entry == entries.end() ? "" : entry->second;
  }
};

/// Reads the events of a recording, one after the other; a failure of the visitor ends the reading. Chooses
/// the arithmetic that the recording was made with (base/instruction_set.hpp). Damaged messages count as
/// damaged.
///
/// kParse for a file that is no recording of ours. kInvalidArgument for a recording of `simulate`, whose
/// commands came from another program, and for an arithmetic that this processor lacks.
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

/// Result of computing a recording's commands again.
struct ReplayReport {
  std::string recorded_by;  ///< program and version
  std::string controller;
  std::string track;
  std::uint64_t steps = 0;      ///< steps in the file
  std::uint64_t identical = 0;  ///< steps with the same command, rung and gate, bit for bit
  std::uint64_t different = 0;
  std::uint64_t unknown = 0;                      ///< steps after missing ones: their history is unknown
  std::optional<std::uint64_t> first_difference;  ///< cycle of the first difference
  std::uint64_t late = 0;                         ///< steps with a spent deadline; they are repeated, too
  std::uint64_t damaged = 0;                      ///< chunks that were left out
  bool is_complete = false;                       ///< the file was closed as it should be

  [[nodiscard]] bool is_verified() const { return steps > 0 && identical == steps; }
};

/// Builds the controller that a recording describes, or that `make` makes, runs the control cycle with every
/// recorded measurement, and compares the commands with the recorded ones.
///
/// All come out the same, those in real time too: a step whose deadline was spent has recorded which question
/// to the clock said so (base/deadline.hpp), and gets the same answer again. Fails when the file cannot be
/// read, is no recording of ours, or has no step.
[[nodiscard]] Result<ReplayReport> verify_recording(const std::string& path, const run::Factories& make = {});

/// The file metadata.yaml beside a recording, which makes its folder a bag of rosbag2.
[[nodiscard]] std::string bag_metadata_path(const std::string& recording);

/// Fails where the folder is another recording's bag already: its metadata.yaml names another file.
[[nodiscard]] Result<void> can_be_bag(const std::string& recording);

/// Writes metadata.yaml beside a recording, of version 5, which rosbag2 reads from ROS 2 Humble on: the
/// topics in CDR with their messages counted. Chicane's own topics are among them; players skip unknown
/// types. Reads the whole recording. kIo as read_mcap() fails, and where the file cannot be
/// written.
[[nodiscard]] Result<void> write_bag_metadata(const std::string& recording);

/// Copies a recording into a file with an index and no compression, as browsers read it: also one whose
/// writer was killed. `to` must not exist yet. How much there was to read; fails as read_mcap() and
/// McapWriter do.
[[nodiscard]] Result<telemetry::McapReport> indexed_copy(const std::string& from, const std::string& to);

/// Unused path in the folder for temporary files; whatever is made there is removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view extension);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace chicane::recording
