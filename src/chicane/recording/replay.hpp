// SPDX-License-Identifier: MIT
// Recordings read and computed again: their events, the check of every command, copies, and bags of ROS 2.
#pragma once

#include <bit>
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

/// Topic of the messages that viewers show, one for each control step.
inline constexpr std::string_view kFrameTopic = "/chicane/frame";

/// Control step with its place on the recording's time line.
struct RecordedStep {
  protocol::Step step;
  double log_time = 0.0;  ///< [s]
};

/// Event from which a recording is computed again. A scenario begins a run.
using RecordedEvent = std::variant<scenario::Scenario, telemetry::Change, RecordedStep>;

/// Description in a recording: program, scenario, mode.
struct RecordingHead {
  std::map<std::string, std::string, std::less<>> entries{};  ///< metadata "run", docs/viewer.md#recordings
  /// Text of an entry; empty without it.
  [[nodiscard]] std::string operator[](const std::string& key) const {
    const auto entry = entries.find(key);
    return entry == entries.end() ? "" : entry->second;
  }
};

/// Reads the events of a recording in order; a failure of the visitor ends the reading. Chooses the
/// arithmetic of the recording for this program (base/instruction_set.hpp). Counts damaged messages in the
/// report.
///
/// kParse for a file that is no recording of ours. kInvalidArgument for a recording of `simulate`, whose
/// commands came from another program, and for an arithmetic that this processor lacks.
[[nodiscard]] Result<telemetry::McapReport> read_recording(
    const std::string& path, RecordingHead& head,
    const std::function<Result<void>(const RecordedEvent&)>& visit);

/// Scenario of the first run in a recording of `drive`. Fails as read_recording(), and with kInvalidArgument
/// for a recording of `serve`, whose car is not ours.
[[nodiscard]] Result<scenario::Scenario> recorded_scenario(const std::string& path);

/// Whether a file is a log of another program. By name: a CSV table, a bag in SQLite, the folder of a bag. By
/// its topics: an MCAP file with odometry in CDR, and without control steps of ours.
[[nodiscard]] bool is_foreign_log(const std::string& file);

/// Checks that a recording can be shown, and returns its extent. kParse for bags of other programs, and for a
/// recording without a whole control step; otherwise fails as telemetry::read_mcap().
[[nodiscard]] Result<telemetry::McapReport> check_recording(const std::string& path);

/// Result of computing a recording's commands again.
struct ReplayReport {
  std::string recorded_by;  ///< program and version
  std::string controller;
  std::string track;
  std::uint64_t steps = 0;                        ///< steps in the file
  std::uint64_t identical = 0;                    ///< steps with the same command, rung and gate, bit for bit
  std::uint64_t different = 0;                    ///< steps with another command, rung or gate
  std::uint64_t unknown = 0;                      ///< steps after missing ones, which cannot be computed
  std::optional<std::uint64_t> first_difference;  ///< cycle of the first difference; none: no difference
  std::uint64_t late = 0;                         ///< steps with a spent deadline, which are computed as well
  std::uint64_t damaged = 0;                      ///< chunks and messages left out
  bool is_complete = false;                       ///< McapReport::is_complete

  /// Whether all steps of the file are identical.
  [[nodiscard]] bool is_verified() const { return steps > 0 && identical == steps; }
};

/// Computes a recording again: runs the control cycle of the recorded scenario, or with the parts by `make`,
/// with every recorded measurement, and compares the commands with the recorded ones.
///
/// All commands are equal, also those of runs in real time: a step whose deadline was spent has recorded at
/// which look at the clock that was found (base/deadline.hpp), and finds it there again. Fails when the file
/// cannot be read, is no recording of ours, or has no step.
[[nodiscard]] Result<ReplayReport> verify_recording(const std::string& path, const run::Factories& make = {});

/// Path of metadata.yaml beside a recording, which makes the folder a bag of rosbag2.
[[nodiscard]] std::string bag_metadata_path(const std::string& recording);

/// Checks that the folder is not the bag of another recording. Fails if its metadata.yaml names another file.
[[nodiscard]] Result<void> can_be_bag(const std::string& recording);

/// Writes metadata.yaml beside a recording, in version 5, which rosbag2 reads since ROS 2 Humble: the topics
/// in CDR with the counts of their messages. Chicane's own topics are among them, because players skip
/// unknown types. Reads the whole recording. Fails as read_mcap(), and with kIo when the file cannot be
/// written.
[[nodiscard]] Result<void> write_bag_metadata(const std::string& recording);

/// Copies a recording, also of a writer that was killed, into a file with an index and without compression,
/// which browsers can read. `to` must not exist. Returns the extent of `from`. Fails as read_mcap() and
/// McapWriter.
[[nodiscard]] Result<telemetry::McapReport> indexed_copy(const std::string& from, const std::string& to);

/// Unused path in the folder for temporary files. The destructor removes the file at that path.
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

/// Whether two numbers have the same bits.
[[nodiscard]] inline bool is_same_number(double a, double b) noexcept {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace chicane::recording
