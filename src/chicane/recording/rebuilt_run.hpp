// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/lap_planner.hpp"
#include "chicane/run/setting.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::recording {

/// What was measured and sent tells of everything before it, plant and controller: a difference anywhere
/// shows up here. True when every bit is the same.
[[nodiscard]] bool is_same(const telemetry::Frame& frame, const protocol::Step& step) noexcept;

/// A run of ours that is computed again, step by recorded step, and may go on by itself from there. One
/// thread.
class RebuiltRun {
 public:
  using OnLap = std::function<void(const telemetry::CompletedLap&)>;

  /// `on_lap` hears of each lap that is completed.
  explicit RebuiltRun(OnLap on_lap = {}) : on_lap_{std::move(on_lap)} {}

  /// From its start. Fails as ClosedLoop::create() does.
  [[nodiscard]] Result<void> begin(const scenario::Scenario& scenario, const run::Factories& make);
  /// From where a copy of it has come to. Pre: not null.
  void begin(std::unique_ptr<run::ClosedLoop> loop) { loop_ = std::move(loop); }
  void forget() noexcept { loop_.reset(); }
  [[nodiscard]] bool has_begun() const noexcept { return loop_ != nullptr; }

  /// The rest is for a run that has begun.
  void apply(const run::Setting& setting);
  const telemetry::Frame& follow(const protocol::Step& step);
  /// Physics up to the next control step.
  void finish_cycle();
  /// One physics step of a run that goes on by itself. True when there was a control step.
  bool advance();
  /// After a control step of advance(): what is planned beside a run that goes on by itself.
  void race_by_learned_lap();
  [[nodiscard]] run::ClosedLoop& loop() const { return *loop_; }

 private:
  void tell_lap();

  OnLap on_lap_;
  std::unique_ptr<run::ClosedLoop> loop_;
  run::LapPlanner planner_{run::LapPlanner::Clock::kVirtual};
};

}  // namespace chicane::recording
