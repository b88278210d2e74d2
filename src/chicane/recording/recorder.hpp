// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
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

/// Names of a recording's attachments (docs/viewer.md#recordings).
inline constexpr const char* kRecordedScenario = "scenario.yaml";  ///< attachment
inline constexpr const char* kRecordedRun = "run";                 ///< metadata
inline constexpr const char* kSimulateMode = "simulate";  ///< Run::mode: the controller was another's

/// Description of a run, the same from step to step.
struct RecordedRun {
  protocol::Run run;
  scenario::Scenario scenario;
};

struct RecorderOptions {
  std::string path;
  protocol::Run run;
  scenario::Scenario scenario;
  bool is_compressed = false;  ///< by Zstandard
  double step_budget = 0.0;    ///< deadline of each control step [s]; 0 = none
  /// Whether a full buffer stops the run, as in virtual time; otherwise the newest frames are left out and
  /// counted.
  bool may_wait = false;
  /// Hears at once, on the writing thread, that the file cannot be written, and when it can again.
  std::function<void(std::string_view)> say{};
};

struct RecorderReport {
  std::uint64_t frames = 0;    ///< frames in the file
  std::uint64_t left_out = 0;  ///< the disk was too slow
  std::uint64_t missing = 0;   ///< the disk was full, or failed otherwise
  std::uint64_t bytes = 0;
};

/// Records a run as an MCAP file: all topics of protocol::ros_topics(), and every control step to the last
/// bit (protocol/step_codec.hpp), so that verify_recording() can compute it again. What is recorded is handed
/// to the operating system within 100 ms. A thread of its own encodes and writes; memory is bounded by 128
/// frames and one chunk.
///
/// A disk that cannot be written is said so at once, and tried again twice a second: frames until then are
/// missing, and counted; changes, laps and descriptions follow when there is room again.
class Recorder {
 public:
  /// Writes what describes the run to the file before it returns. kIo as McapWriter::create does,
  /// and when that cannot be written.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> create(RecorderOptions options);
  /// finish(), if it was not called; errors are then not reported.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// One thread, the control thread: copies the frame, allocates nothing, and waits only with may_wait.
  void record(const telemetry::Frame& frame) noexcept;
  /// The same thread: a setting changed, or a fault began or ended, before the next frame.
  void record(const telemetry::Change& change) noexcept;
  /// The same thread: a lap was completed, the last one of a run included.
  void record(const telemetry::CompletedLap& lap) noexcept;
  /// Tells the recorder on the same thread that the next frame is the first of another run, with other
  /// settings and cycle 0. A restart of the same run needs no call.
  void record(std::unique_ptr<const RecordedRun> run) noexcept;
  /// The same thread: there are news of the run's limit.
  void record(std::shared_ptr<const lap_time::LimitAnswer> limit) noexcept;
  /// Writes the rest and closes the file. kIo with what went wrong, and how much is missing, where the
  /// file could not be written to its end.
  [[nodiscard]] Result<RecorderReport> finish();

 private:
  static constexpr std::uint64_t kReserve = 64;  ///< room for important records: no frames
  using Entry =
      std::variant<telemetry::Frame, telemetry::Change, telemetry::CompletedLap,
                   std::unique_ptr<const RecordedRun>, std::shared_ptr<const lap_time::LimitAnswer>>;

  Recorder(RecorderOptions options, std::unique_ptr<telemetry::McapWriter> writer);
  template <class Note>
  void record(Note&& note, std::uint64_t reserve) noexcept;
  void work();
  void begin();
  [[nodiscard]] Result<void> describe();
  [[nodiscard]] Result<void> flush();
  void write(const telemetry::Frame& frame);
  void write(const telemetry::Change& change);
  void write(const telemetry::CompletedLap& lap);
  void write(std::unique_ptr<const RecordedRun>& run);
  void write(std::shared_ptr<const lap_time::LimitAnswer>& limit);
  void put(std::uint16_t channel, std::uint64_t log_time, std::uint64_t time, std::string_view bytes);
  void note(const Result<void>& flushed);
  void write(protocol::Cadence cadence, const telemetry::Frame& frame = {}, std::uint64_t time = 0);

  RecorderOptions options_;
  std::unique_ptr<telemetry::McapWriter> writer_;
  run::ThreadQueue<Entry, 2 * kReserve> ring_;
  std::atomic<bool> wants_end_{false};
  std::uint64_t left_out_ = 0;  ///< the control thread's

  // The writing thread's, until it has ended.
  std::uint16_t step_channel_ = 0, change_channel_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t last_log_time_ = 0;  ///< [ns]
  double last_time_ = 0.0;           ///< run time of the last frame [s]
  telemetry::LapLedger ledger_;
  std::uint64_t earlier_runs_ = 0;  ///< log time minus the run's own time [ns]
  std::uint64_t missing_ = 0;       ///< frames
  bool is_failing_ = false;         ///< the disk refused the last write
  bool is_undescribed_ = false;     ///< the run's description waits for room
  Result<void> state_;
  std::thread thread_;
};

}  // namespace chicane::recording
