// SPDX-License-Identifier: MIT
// Publisher of a live run: hands frames, laps and changes to viewers, recorder, log and callbacks.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "chicane/live/live_settings.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/live/run_log.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/run_steps.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {

/// Callbacks of a live run; empty functions are not called. All but `say` are called on the thread that
/// drives.
struct LiveHooks {
  std::function<void(const telemetry::Frame&)> on_frame{};       ///< called after each control cycle
  std::function<void(const telemetry::CompletedLap&)> on_lap{};  ///< called after each lap
  std::function<void(const telemetry::Change&)> on_change{};     ///< called after each applied change
  std::function<void(std::string_view)> say{};                   ///< gets a line for people; any thread
};

/// Listeners of a live run besides viewers; null: none. All outlive the publisher.
struct RunListeners {
  recording::Recorder* recorder = nullptr;
  RunLimit* limit = nullptr;  ///< limit, whose news are recorded
  RunLog* log = nullptr;      ///< memory for other futures
  LiveHooks hooks{};
};

/// Services pause, step and reset, which set requests in `controls`.
[[nodiscard]] wire::ViewerServices run_services(run::RunControls& controls);

/// Copy of `options` with functions that show viewers the run in construction, and the current delay and car.
/// `viewer` outlives the settings.
[[nodiscard]] LiveSettingsOptions with_viewer(wire::ViewerEndpoint& viewer, LiveSettingsOptions options);

/// Hands the events of a live run to viewers, their settings, and the listeners. Adds two kinds of events: a
/// fault began or ended by itself, and, once for each run, the run is over. Used on the thread that drives.
class RunPublisher {
 public:
  /// `viewer` and `settings` outlive this.
  RunPublisher(wire::ViewerEndpoint& viewer, LiveSettings& settings, RunListeners listeners = {});

  /// Publishes a frame; call it after each control cycle.
  void frame(const telemetry::Frame& frame);
  void lap(const telemetry::CompletedLap& lap);
  /// Publishes a change that was applied.
  void change(const telemetry::Change& change);
  /// Reports the end of the run and its reason to viewers. False, without effect, if it was reported before:
  /// a run that continues after its end stays over.
  bool end(const telemetry::RunSummary& summary);
  [[nodiscard]] bool has_reported_end() const { return has_reported_end_; }
  /// Compares the laps of a run that has ended with its limit, and records the limit. Waits as
  /// RunLimit::compare(), until `wants_stop`. Pre: RunListeners::limit is not null.
  void compare(telemetry::RunSummary& summary, const std::atomic<bool>& wants_stop);
  void say(std::string_view line) const;

  /// Time of the last frame [s].
  [[nodiscard]] double time() const { return time_; }

 private:
  /// Publishes faults that began or ended by themselves, as changes.
  void tell_faults(const telemetry::Frame& frame);
  /// Records news of the limit.
  void record_limit();

  wire::ViewerEndpoint& viewer_;
  LiveSettings& settings_;
  RunListeners to_;
  const std::vector<protocol::Control> faults_;  ///< switches of faults, in the order of the bits
  std::uint32_t reported_faults_ = 0;            ///< bits of the faults that are on for viewers
  bool has_reported_end_ = false;                ///< end() was called in this run
  double time_ = 0.0;                            ///< time of the last frame [s]
};

}  // namespace chicane::live
