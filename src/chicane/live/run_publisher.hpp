// SPDX-License-Identifier: MIT
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
  std::function<void(const telemetry::Frame&)> on_frame{};
  std::function<void(const telemetry::CompletedLap&)> on_lap{};
  std::function<void(const telemetry::Change&)> on_change{};
  std::function<void(std::string_view)> say{};  ///< one line for people; any thread
};

/// Listeners of a live run that are no viewers; null: none. All outlive the publisher.
struct RunListeners {
  recording::Recorder* recorder = nullptr;
  RunLimit* limit = nullptr;  ///< limit whose news are recorded
  RunLog* log = nullptr;
  LiveHooks hooks{};
};

/// Pause, step and reset of a run, which `controls` asks for.
[[nodiscard]] wire::ViewerServices run_services(run::RunControls& controls);

/// `options` with hooks that show viewers the run that is being built, and the delay and car that hold.
/// `viewer` outlives the settings.
[[nodiscard]] LiveSettingsOptions with_viewer(wire::ViewerEndpoint& viewer, LiveSettingsOptions options);

/// Hands the events of a live run to viewers, to the settings that they see, and to its listeners. Adds
/// events without a request: a fault began or ended by itself, and, once for each run, the run is over. One
/// thread, the one that drives.
class RunPublisher {
 public:
  /// `viewer` and `settings` outlive this.
  RunPublisher(wire::ViewerEndpoint& viewer, LiveSettings& settings, RunListeners listeners = {});

  /// Publishes a frame; call it after each control cycle.
  void frame(const telemetry::Frame& frame);
  void lap(const telemetry::CompletedLap& lap);
  /// A change was applied.
  void change(const telemetry::Change& change);
  /// Ends the run: sends viewers the reason, and returns true, the first time. A run that is driven on stays
  /// over.
  bool end(const telemetry::RunSummary& summary);
  [[nodiscard]] bool has_reported_end() const { return has_reported_end_; }
  /// Compares the laps of a run that has ended with its limit, and records the limit. Waits for it as
  /// RunLimit::compare() does, until `wants_stop`. Pre: there is a limit.
  void compare(telemetry::RunSummary& summary, const std::atomic<bool>& wants_stop);
  void say(std::string_view line) const;

  /// Time of the last frame [s].
  [[nodiscard]] double time() const { return time_; }

 private:
  void tell_faults(const telemetry::Frame& frame);
  void record_limit();

  wire::ViewerEndpoint& viewer_;
  LiveSettings& settings_;
  RunListeners to_;
  const std::vector<protocol::Control> faults_;
  std::uint32_t reported_faults_ = 0;  ///< bits, as viewers know them
  bool has_reported_end_ = false;
  double time_ = 0.0;
};

}  // namespace chicane::live
