// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "chicane/live/journal.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/lap_planner.hpp"
#include "chicane/telemetry/change.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {

/// What a program shows of a live run beside viewers and recording, on the control thread. Empty functions
/// are not called.
struct LiveHooks {
  std::function<void(const telemetry::Frame&)> on_frame{};
  std::function<void(const telemetry::CompletedLap&)> on_lap{};
  std::function<void(std::string_view)> say{};  ///< one line for people; any thread
};

/// Hands what happens in a live run to the recording, viewers, the settings that
/// viewers see, and the program's own hooks. One thread, the control thread.
class RunOutputs {
 public:
  /// `recorder` and `journal` may be null: nothing is recorded, or known for a branch. All outlive this.
  RunOutputs(recording::Recorder* recorder, wire::ViewerEndpoint& viewer, LiveSettings& settings,
             RunLimit& limit, const LiveHooks& hooks, Journal* journal = nullptr)
      : recorder_{recorder},
        viewer_{viewer},
        settings_{settings},
        limit_{limit},
        hooks_{hooks},
        journal_{journal} {}

  void frame(const telemetry::Frame& frame) {
    record_limit();
    record(frame);
    if (journal_ != nullptr) journal_->note(frame);
    viewer_.publish(frame);
    time_ = frame.time;
    if (hooks_.on_frame) hooks_.on_frame(frame);
  }
  void lap(const telemetry::CompletedLap& lap) {
    record(lap);
    viewer_.publish(lap, time_);
    if (hooks_.on_lap) hooks_.on_lap(lap);
  }
  void change(const telemetry::Change& change) {
    record(change);
    if (journal_ != nullptr) journal_->note(change);
    settings_.tell(change);
    if (change.name.view() == run::LapPlanner::kChange)
      say("races by a new lap, planned with " + std::string(change.value.view()) + " of the believed grip");
  }
  /// The next frame is the first of another run.
  void begin(std::unique_ptr<const recording::RecordedRun> run) {
    if (journal_ != nullptr) journal_->begin(run->scenario);
    record(std::move(run));
  }
  /// The limit, when there are news of it.
  void record_limit() {
    if (auto news = limit_.news()) record(std::move(news));
  }
  void say(std::string_view line) const {
    if (hooks_.say) hooks_.say(line);
  }

 private:
  template <class What>
  void record(What&& what) {
    if (recorder_ != nullptr) recorder_->record(std::forward<What>(what));
  }

  recording::Recorder* recorder_;
  wire::ViewerEndpoint& viewer_;
  LiveSettings& settings_;
  RunLimit& limit_;
  const LiveHooks& hooks_;
  Journal* journal_;
  double time_ = 0.0;  ///< of the last frame [s]
};

}  // namespace chicane::live
