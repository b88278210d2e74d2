// SPDX-License-Identifier: MIT
// CPU time of each part of the control step of `default`, step by step over whole laps.
//
//     step_bench [CAR [TRACK [LAPS]]]        udacity lakeside 2
//
// The drive is recorded once and its measurements are given to fresh controllers again and again: they do the
// same work every time, so the least of the repeats is what a step costs on an idle core.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "chicane/protocol/library.hpp"
#include "chicane/road/road.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/make.hpp"
#include "chicane/tracking/state_estimator.hpp"
#include "problems/cpu_time.hpp"

namespace chicane::bench {
namespace {

constexpr int kRepeats = 7;

struct Cycle {
  model::Measurement measurement;
  model::Command command;
};

/// Microseconds by cycle.
using Times = std::vector<double>;

double now_us() { return 1e6 * cpu_time(); }

std::vector<Cycle> record(const scenario::Scenario& scenario) {
  std::vector<Cycle> cycles;
  const auto loop = run::ClosedLoop::create(scenario);
  if (!loop) return cycles;
  while (!(*loop)->is_over()) {
    if ((*loop)->advance()) cycles.push_back({(*loop)->frame().measurement, (*loop)->frame().result.command});
  }
  return cycles;
}

/// Least time of each cycle over `kRepeats` drives. `begin` starts a drive, `step` is one cycle and returns
/// its time.
Times least(std::size_t cycles, const std::function<void()>& begin,
            const std::function<double(std::size_t)>& step) {
  Times best(cycles, 1e9);
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    begin();
    for (std::size_t i = 0; i < cycles; ++i) best[i] = std::min(best[i], step(i));
  }
  return best;
}

void print_row(const char* name, Times times) {
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", name, at(0.5), at(0.99), at(0.999), at(1.0));
}

Times time_whole_step(const scenario::Scenario& scenario, const std::vector<Cycle>& cycles, Times& solve) {
  const auto controller = std::move(*run::make_controller(scenario));
  safety::CommandGate gate(scenario.vehicle);
  solve.assign(cycles.size(), 1e9);
  return least(
      cycles.size(),
      [&] {
        controller->reset();
        gate.reset();
      },
      [&](std::size_t i) {
        const double start = now_us();
        const controller::StepResult& answer = controller->step(cycles[i].measurement, Deadline::stopwatch());
        (void)gate.pass(answer.command, scenario.control_period);
        const double taken = now_us() - start;
        solve[i] = std::min(solve[i], 1e6 * answer.report.solve_time);
        return taken;
      });
}

Times time_road(const scenario::Scenario& scenario, const std::vector<Cycle>& cycles) {
  const controller::TrackingMpcOptions& options =
      std::get<controller::TrackingMpcOptions>(scenario.controllers);
  road::Road road({.half_width = options.assumed_half_width,
                   .smoothing_width = options.smoothing_width,
                   .remember_waypoints = options.remember_waypoints,
                   .speed = {.speed_limit = options.speed_limit,
                             .grip_share = options.grip_share,
                             .brake_share = options.brake_share}},
                  scenario.vehicle);
  return least(
      cycles.size(), [&] { road.reset(); },
      [&](std::size_t i) {
        const double start = now_us();
        road.add(cycles[i].measurement);
        return now_us() - start;
      });
}

Times time_estimator(const scenario::Scenario& scenario, const std::vector<Cycle>& cycles) {
  const model::PredictionModel model(scenario.vehicle);
  tracking::StateEstimator estimator(model);
  tracking::CommandHistory sent;
  return least(
      cycles.size(),
      [&] {
        estimator.reset();
        sent.clear();
      },
      [&](std::size_t i) {
        const model::Measurement& now = cycles[i].measurement;
        const double start = now_us();
        estimator.correct(now, sent);
        (void)estimator.predict(now.time + now.delay, sent);
        const double taken = now_us() - start;
        sent.add(now.time + now.delay, cycles[i].command);
        return taken;
      });
}

Times time_clock(std::size_t cycles) {
  return least(
      cycles, [] {},
      [](std::size_t) {
        const double start = now_us();
        return now_us() - start;
      });
}

int run(const std::string& car, const std::string& track, const std::string& laps) {
  const auto scenario = protocol::compose(
      {.scenario_file = {},
       .settings = {{"car", car}, {"track", track}, {"laps", laps}, {"latency_ms", "100"}}});
  if (!scenario) {
    fmt::print(stderr, "{}\n", scenario.error().message);
    return 1;
  }
  const std::vector<Cycle> cycles = record(*scenario);
  if (cycles.empty()) return 1;
  Times solve;
  const Times whole = time_whole_step(*scenario, cycles, solve);
  const Times road = time_road(*scenario, cycles);
  const Times estimator = time_estimator(*scenario, cycles);
  Times rest = whole;
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= solve[i] + road[i] + estimator[i];
  fmt::print("{} on {}, {} laps, {} steps, least of {} runs [µs]\n\n", car, track, laps, cycles.size(),
             kRepeats);
  fmt::print("| part | p50 | p99 | p99.9 | max |\n|---|--:|--:|--:|--:|\n");
  print_row("whole step with gate", whole);
  print_row("map, line, speed plan", road);
  print_row("estimate and delay", estimator);
  print_row("optimisation", solve);
  print_row("place, guess, stages, plan", rest);
  print_row("reading the clock twice (in every row but the optimisation)", time_clock(cycles.size()));
  return 0;
}

}  // namespace
}  // namespace chicane::bench

int main(int argc, char** argv) {
  const auto argument = [&](int i, const char* otherwise) {
    return std::string(i < argc ? argv[i] : otherwise);
  };
  return chicane::bench::run(argument(1, "udacity"), argument(2, "lakeside"), argument(3, "2"));
}
