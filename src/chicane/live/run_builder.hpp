// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/live/worker.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/telemetry/change.hpp"

namespace chicane::live {

/// A run that was chosen while another one goes on.
struct ChosenRun {
  scenario::Scenario scenario;
  std::vector<telemetry::Change> choices{};  ///< what was chosen, each key once, in order
};

/// A run that may begin, with all that takes time to make.
struct BuiltRun {
  std::unique_ptr<run::ClosedLoop> loop;
  protocol::Run description;                               ///< for viewers
  std::unique_ptr<const recording::RecordedRun> recorded;  ///< for the recording
  std::vector<telemetry::Change> choices{};
};

/// Builds runs on a thread of its own, of low priority: neither the network nor control wait for a track to
/// be read. Of several requests the newest counts: one that waits is replaced, and what becomes of one that
/// is being built then is thrown away. begin() and take() are one thread's.
class RunBuilder {
 public:
  using Describe = std::function<protocol::Run(const run::ClosedLoop&)>;
  /// Instead of ClosedLoop::create, for tests.
  using Create = std::function<Result<std::unique_ptr<run::ClosedLoop>>(const scenario::Scenario&)>;

  /// `describe` is called on the other thread.
  explicit RunBuilder(
      Describe describe,
      Create create = [](const scenario::Scenario& scenario) { return run::ClosedLoop::create(scenario); });
  /// Waits for a build under way.
  ~RunBuilder() = default;

  /// What it makes, at once.
  [[nodiscard]] static Result<std::unique_ptr<BuiltRun>> build(
      ChosenRun run, const Describe& describe, const Create& create = [](const scenario::Scenario& scenario) {
        return run::ClosedLoop::create(scenario);
      });

  void begin(ChosenRun run);
  /// What became of the newest request, once; none while it is being built, and when there is none.
  [[nodiscard]] std::optional<Result<std::unique_ptr<BuiltRun>>> take();

 private:
  void work();

  Describe describe_;
  Create create_;
  std::mutex mutex_;  ///< of all below
  std::optional<ChosenRun> wish_;
  std::uint64_t newest_ = 0;  ///< number of the last request
  std::optional<Result<std::unique_ptr<BuiltRun>>> result_;
  Worker worker_;  // last
};

}  // namespace chicane::live
