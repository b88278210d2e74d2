// SPDX-License-Identifier: MIT
// Recorder: writes a run to an MCAP file while it is driven, without delaying the control thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <variant>

#include "chicane/base/result.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::recording {

// Names in a recording (docs/viewer.md#recordings).
inline constexpr const char* kRecordedScenario = "scenario.yaml";  ///< attachment with the scenario
inline constexpr const char* kRecordedRun = "run";  ///< metadata with the description of the run
inline constexpr const char* kSimulateMode =
    "simulate";  ///< Run::mode of a run by another program's controller

/// Description of a run, constant during the run.
struct RecordedRun {
  protocol::Run run;
  scenario::Scenario scenario;
};

/// Options of a Recorder.
struct RecorderOptions {
  std::string path;  ///< file to create
  protocol::Run run;
  scenario::Scenario scenario;
  bool is_compressed = false;  ///< compress by Zstandard
  double step_budget = 0.0;    ///< deadline of each control step [s]; 0 = none
  /// Whether the run waits while the buffer is full, as in virtual time. Otherwise frames are left out and
  /// counted.
  bool may_wait = false;
  /// Called on the writing thread when the file cannot be written, and when it can be written again.
  std::function<void(std::string_view)> say{};
};

/// Result of a recording.
struct RecorderReport {
  std::uint64_t frames = 0;    ///< frames in the file
  std::uint64_t left_out = 0;  ///< frames left out because the disk was too slow
  std::uint64_t missing = 0;   ///< frames lost because the disk was full, or failed otherwise
  std::uint64_t bytes = 0;     ///< size of the file
};

/// Records a run as an MCAP file: all topics of protocol::ros_topics(), and every control step to the last
/// bit (protocol/step_codec.hpp), so that verify_recording() can compute it again. A thread encodes and
/// writes; records reach the operating system within 100 ms. Memory is bounded by 128 frames and one chunk.
///
/// A failure of the disk is reported at once, and writing is tried again twice a second. Frames until then
/// are lost and counted; changes, laps and descriptions are written afterwards.
class Recorder {
 public:
  /// Creates the file, and writes the description of the run before it returns. kIo as McapWriter::create(),
  /// and when the description cannot be written.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> create(RecorderOptions options);
  /// Calls finish() if it was not called; its errors are then lost.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // All record() belong to one thread, the control thread. They allocate nothing, and wait only with
  // may_wait.
  /// Records a copy of a frame.
  void record(const telemetry::Frame& frame) noexcept;
  /// Records a change of a setting, or the beginning or end of a fault, before the next frame.
  void record(const telemetry::Change& change) noexcept;
  /// Records a completed lap.
  void record(const telemetry::CompletedLap& lap) noexcept;
  /// Begins another run, with other settings and cycle 0 in the next frame. A restart of the same run needs
  /// no call.
  void record(std::unique_ptr<const RecordedRun> run) noexcept;
  /// Records an answer on the run's limit.
  void record(std::shared_ptr<const lap_time::LimitAnswer> limit) noexcept;
  /// Writes the rest and closes the file. kIo, with the error and the number of lost frames, when the file
  /// could not be written to its end.
  [[nodiscard]] Result<RecorderReport> finish();

 private:
  static constexpr std::uint64_t kReserve = 64;  ///< places of the ring that frames may not use; chosen
  using Entry =
      std::variant<telemetry::Frame, telemetry::Change, telemetry::CompletedLap,
                   std::unique_ptr<const RecordedRun>, std::shared_ptr<const lap_time::LimitAnswer>>;

  Recorder(RecorderOptions options, std::unique_ptr<telemetry::McapWriter> writer);
  /// Puts a record into the ring, and leaves `reserve` places free.
  template <class Note>
  void record(Note&& note, std::uint64_t reserve) noexcept;
  /// Writes records until finish(), on the writing thread.
  void work();
  /// Writes channels and description, so that a run that is killed at once still has its scenario.
  void begin();
  /// Writes the description of the current run.
  [[nodiscard]] Result<void> describe();
  /// Writes the chunk, and the description of the current run if it is still missing.
  [[nodiscard]] Result<void> flush();
  void write(const telemetry::Frame& frame);
  void write(const telemetry::Change& change);
  void write(const telemetry::CompletedLap& lap);
  void write(std::unique_ptr<const RecordedRun>& run);
  void write(std::shared_ptr<const lap_time::LimitAnswer>& limit);
  /// Adds a message to the chunk; times in [ns].
  void put(std::uint16_t channel, std::uint64_t log_time, std::uint64_t time, std::string_view bytes);
  /// Reports for people when the disk begins or ceases to refuse writes.
  void note(const Result<void>& flushed);
  /// Writes all topics of a cadence, with the content of `frame`.
  void write(protocol::Cadence cadence, const telemetry::Frame& frame = {}, std::uint64_t time = 0);

  RecorderOptions options_;
  std::unique_ptr<telemetry::McapWriter> writer_;
  run::ThreadQueue<Entry, 2 * kReserve> ring_;  ///< records on their way to the writing thread
  std::atomic<bool> wants_end_{false};          ///< finish() was called
  std::uint64_t left_out_ = 0;                  ///< frames left out; used by the control thread

  // Used by the writing thread, until it has ended.
  std::uint16_t step_channel_ = 0, change_channel_ = 0;  ///< channels of control steps and changes
  std::uint64_t frames_ = 0;                             ///< frames in the file
  std::uint64_t last_log_time_ = 0;                      ///< log time of the last frame [ns]
  double last_time_ = 0.0;                               ///< run time of the last frame [s]
  telemetry::LapLedger ledger_;                          ///< settings of each lap
  std::uint64_t earlier_runs_ = 0;                       ///< log time minus run time [ns]
  std::uint64_t missing_ = 0;                            ///< frames lost
  bool is_failing_ = false;                              ///< the disk refused the last write
  bool is_undescribed_ = false;                          ///< the description of the run is not written yet
  Result<void> state_;                                   ///< error of the recording
  std::thread thread_;
};

}  // namespace chicane::recording
