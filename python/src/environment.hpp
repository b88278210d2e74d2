// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "chicane/base/random.hpp"
#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/path.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/roads.hpp"
#include "chicane/scenario/scenario.hpp"
#include "chicane/sim/range_scanner.hpp"

namespace chicane::python {

/// What an agent is told in each step, made of what the sensors say: noise, latency and faults included.
enum class Observation : std::uint8_t {
  kTrack,      ///< place on the road, which the agent knows, and the curvature ahead
  kWaypoints,  ///< the waypoints of telemetry, seen from the car
  kPose,       ///< the measurement as it is
  kScan,       ///< what a laser on the car sees of the walls along the road
};

/// A setting that is drawn evenly from [low, high] at the beginning of each episode.
struct Draw {
  std::string key;  ///< of the schema
  double low = 0.0, high = 0.0;
};

struct EnvironmentOptions {
  Observation observation = Observation::kTrack;
  double off_road_cost = 10.0;   ///< taken from the reward in the step in which a tyre leaves the road [m]
  bool ends_off_road = true;     ///< and the episode ends there
  double episode_limit = 0.0;    ///< truncates the episode [s]; 0: no limit
  bool starts_anywhere = false;  ///< on the centre line, standing; else at the track's start
  std::vector<Draw> draws{};
  std::vector<std::string> faults{};  ///< one of them each episode, NAME@S+S*X; empty: none
};

struct StepOutcome {
  double reward = 0.0;  ///< metres of the centre line gained, less the cost of leaving the road
  bool terminated = false;
  bool truncated = false;
};

/// run::ClosedLoop for an agent: step() sends a command, drives up to the next measurement and tells it. The
/// agent answers each measurement with one command, as a controller does, so the same commands give the same
/// run, bit for bit. One thread.
class Environment {
 public:
  static constexpr int kCurvatures = 10;   ///< ahead, of Observation::kTrack
  static constexpr double kSpacing = 5.0;  ///< between them [m], times the car's scale

  /// Fails as run::ClosedLoop::create() does, and for a draw whose key or range is none of the schema.
  /// `roads` may be shared by environments that are made and reset on one thread.
  [[nodiscard]] static Result<std::unique_ptr<Environment>> create(const scenario::Scenario& scenario,
                                                                   EnvironmentOptions options,
                                                                   std::shared_ptr<run::Roads> roads);

  /// Numbers in an observation.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// Begins an episode; everything that is random in it follows from `seed`. Fails for a combination of draws
  /// that cannot be driven.
  [[nodiscard]] Result<void> reset(std::uint64_t seed);
  /// One control period. Steps beyond the end of an episode change nothing.
  StepOutcome step(const model::Command& action) noexcept;
  /// The last measurement, size() numbers; not-a-number where it says nothing.
  void observe(std::span<double> to) const noexcept;
  /// Changes a setting of the episode that goes on, or the truth of a fault ("fault.half_grip"). Fails as
  /// run::read_setting() does.
  [[nodiscard]] Result<void> set(const std::string& key, const std::string& text);

  [[nodiscard]] const run::ClosedLoop& loop() const noexcept { return *loop_; }
  /// The values that were drawn for this episode, in the order of the options.
  [[nodiscard]] const std::vector<double>& drawn() const noexcept { return drawn_; }
  /// Number of the measurement in the episode, and of commands it was given.
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

 private:
  class Agent;
  Environment(const scenario::Scenario& scenario, EnvironmentOptions options,
              std::shared_ptr<run::Roads> roads);
  [[nodiscard]] Result<scenario::Scenario> draw(Random& random);
  void place(Random& random);
  void find_foot() noexcept;
  void observe_track(std::span<double> to) const noexcept;
  void observe_waypoints(std::span<double> to) const noexcept;
  void observe_pose(std::span<double> to) const noexcept;
  void observe_scan(std::span<double> to) const noexcept;

  scenario::Scenario scenario_;
  EnvironmentOptions options_;
  std::size_t size_;
  std::shared_ptr<run::Roads> roads_;
  std::unique_ptr<run::ClosedLoop> loop_;
  Agent* agent_ = nullptr;  ///< the controller of loop_
  model::Measurement seen_;
  road::Projection foot_;                     ///< seen place on the track, where kTrack asks for it
  std::optional<sim::RangeScanner> scanner_;  ///< where kScan asks for it
  double progress_ = 0.0;
  int off_track_events_ = 0;
  bool has_ended_ = true;
  std::uint64_t steps_ = 0;
  std::vector<double> drawn_;
};

}  // namespace chicane::python
