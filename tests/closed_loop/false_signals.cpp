// SPDX-License-Identifier: MIT
#include "closed_loop/false_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"

namespace chicane::attack {
namespace {

using model::Measurement;

constexpr double kMphPerMps = 2.23693629;
constexpr double kKmhPerMps = 3.6;

/// An older content with the time of the new one, as in telemetry without time stamps.
void replace_content(Measurement& now, const Measurement& content) {
  const double time = now.time;
  const double delay = now.delay;
  now = content;
  now.time = time;
  now.delay = delay;
}

/// Draws a direction once, in the first cycle of the signal.
double direction_of(SignalMemory& memory) {
  if (!memory.kept) {
    memory.kept = Measurement{};
    memory.kept->psi = memory.random.uniform(0.0, kTwoPi);
  }
  return memory.kept->psi;
}

void add_headings(std::vector<FalseSignal>& all) {
  for (const double degrees : {90.0, -90.0, 180.0})
    all.push_back(
        {.name = fmt::format("heading{:+.0f}", degrees),
         .measured = [=](SignalMemory&, Measurement& now) { now.psi += degrees_to_radians(degrees); }});
  all.push_back(
      {.name = "heading_mirrored", .measured = [](SignalMemory&, Measurement& now) { now.psi = -now.psi; }});
  all.push_back({.name = "heading_clockwise",
                 .measured = [](SignalMemory&, Measurement& now) { now.psi = 0.5 * kPi - now.psi; }});
}

void add_places(std::vector<FalseSignal>& all) {
  all.push_back({.name = "x_and_y_swapped",
                 .measured = [](SignalMemory&, Measurement& now) { std::swap(now.x, now.y); }});
  all.push_back(
      {.name = "place_of_zeros", .measured = [](SignalMemory&, Measurement& now) { now.x = now.y = 0.0; }});
  all.push_back({.name = "pose_of_zeros",
                 .measured = [](SignalMemory&, Measurement& now) { now.x = now.y = now.psi = 0.0; }});
  all.push_back({.name = "zeros", .measured = [](SignalMemory&, Measurement& now) {
                   now.x = now.y = now.psi = now.speed = now.steer = now.throttle = 0.0;
                 }});
  for (const double speed : {0.1, 0.3, 1.0}) {
    all.push_back({.name = fmt::format("drift_{:g}mps", speed),
                   .measured = [=](SignalMemory& memory, Measurement& now) {
                     const double angle = direction_of(memory);
                     const double distance = speed * memory.time * (now.time - memory.began);
                     now.x += distance * std::cos(angle);
                     now.y += distance * std::sin(angle);
                   }});
  }
  for (const double noise : {0.1, 0.5, 1.0, 2.0}) {
    all.push_back(
        {.name = fmt::format("noise_{:g}m", noise), .measured = [=](SignalMemory& memory, Measurement& now) {
           now.x += noise * memory.length * memory.random.normal();
           now.y += noise * memory.length * memory.random.normal();
         }});
  }
}

void add_speeds(std::vector<FalseSignal>& all) {
  const std::pair<const char*, double> factors[] = {{"speed_half", 0.5},
                                                    {"speed_double", 2.0},
                                                    {"speed_kmh", kKmhPerMps},
                                                    {"speed_mph", kMphPerMps},
                                                    {"speed_negative", -1.0}};
  for (const auto& [name, factor] : factors)
    all.push_back({.name = name,
                   .measured = [factor = factor](SignalMemory&, Measurement& now) { now.speed *= factor; }});
}

void add_times(std::vector<FalseSignal>& all) {
  for (const double age : {0.1, 0.3, 0.8, 1.0}) {
    all.push_back(
        {.name = fmt::format("late_{:g}s", age), .measured = [=](SignalMemory& memory, Measurement& now) {
           replace_content(now, memory.at(now.time - age * memory.time));
         }});
  }
  for (const double age : {0.3, 1.0}) {
    all.push_back({.name = fmt::format("late_up_to_{:g}s", age),
                   .measured = [=](SignalMemory& memory, Measurement& now) {
                     const double late = memory.random.uniform(0.0, age) * memory.time;
                     replace_content(now, memory.at(now.time - late));
                   }});
  }
  all.push_back({.name = "reordered", .measured = [](SignalMemory& memory, Measurement& now) {
                   // Contents of the last three cycles in any order.
                   const auto cycle = static_cast<std::size_t>(memory.random.bits() % 3U);
                   replace_content(now, memory.before(cycle));
                 }});
  all.push_back({.name = "doubled", .measured = [](SignalMemory& memory, Measurement& now) {
                   if (memory.kept) {
                     replace_content(now, *memory.kept);
                     memory.kept.reset();
                   } else {
                     memory.kept = now;
                   }
                 }});
}

void shift_waypoints(Measurement& now, double distance) {
  const Measurement before = now;
  for (int i = 0; i < now.waypoint_count; ++i) {
    const auto here = static_cast<std::size_t>(i);
    const auto next = static_cast<std::size_t>(std::min(i + 1, now.waypoint_count - 1));
    const auto last = static_cast<std::size_t>(std::max(i - 1, 0));
    const Vec2 along = before.waypoints[next] - before.waypoints[last];
    const double length = along.norm();
    if (length > 0.0) now.waypoints[here] += (distance / length) * Vec2{-along.y(), along.x()};
  }
}

void add_waypoints(std::vector<FalseSignal>& all) {
  for (const double distance : {1.0, 3.0, 5.0, -1.0, -3.0, -5.0}) {
    all.push_back({.name = fmt::format("waypoints{:+g}m", distance),
                   .measured = [=](SignalMemory& memory, Measurement& now) {
                     shift_waypoints(now, distance * memory.length);
                   }});
  }
}

void add_resets(std::vector<FalseSignal>& all) {
  all.push_back({.name = "faked_reset_to_start", .measured = [](SignalMemory& memory, Measurement& now) {
                   replace_content(now, memory.first());
                   now.speed = 0.0;
                 }});
  all.push_back({.name = "faked_reset_aside", .measured = [](SignalMemory& memory, Measurement& now) {
                   if (!memory.kept) {
                     memory.kept = now;
                     memory.kept->x -= 6.0 * memory.length * std::sin(now.psi);
                     memory.kept->y += 6.0 * memory.length * std::cos(now.psi);
                     memory.kept->speed = 0.0;
                   }
                   replace_content(now, *memory.kept);
                 }});
  all.push_back({.name = "faked_reset_back", .measured = [](SignalMemory& memory, Measurement& now) {
                   if (!memory.kept) memory.kept = memory.at(now.time - 1.0 * memory.time);
                   replace_content(now, *memory.kept);
                   now.speed = 0.0;
                 }});
  const std::pair<const char*, double> places[] = {
      {"reset_to_start", 0.0}, {"reset_to_third", 0.333}, {"reset_to_two_thirds", 0.667}};
  for (const auto& [name, share] : places) all.push_back({.name = name, .put_on_lap = share});
}

void add_actuators(std::vector<FalseSignal>& all) {
  all.push_back({.name = "steering_half", .actuated = [](model::Command& command) { command.steer *= 0.5; }});
  all.push_back(
      {.name = "steering_times_1.5", .actuated = [](model::Command& command) { command.steer *= 1.5; }});
  for (const double degrees : {7.0, -7.0})
    all.push_back(
        {.name = fmt::format("steering{:+g}deg", degrees),
         .actuated = [=](model::Command& command) { command.steer += degrees_to_radians(degrees); }});
  all.push_back({.name = "brakes_half", .actuated = [](model::Command& command) {
                   if (command.throttle < 0.0) command.throttle *= 0.5;
                 }});
}

}  // namespace

SignalMemory::SignalMemory(std::uint64_t seed, double car_size)
    : random{seed}, length{car_size}, time{std::sqrt(car_size)} {}

void SignalMemory::add(const Measurement& now) {
  if (count_ == 0) first_ = now;
  past_[count_++ % kRemembered] = now;
}

const Measurement& SignalMemory::before(std::size_t cycles) const {
  const std::size_t back = std::min({cycles + 1, count_, kRemembered});
  return past_[(count_ - back) % kRemembered];
}

const Measurement& SignalMemory::at(double when) const {
  std::size_t cycles = 0;
  while (cycles + 1 < std::min(count_, kRemembered) && before(cycles).time > when) ++cycles;
  return before(cycles);
}

std::vector<FalseSignal> false_signals() {
  std::vector<FalseSignal> all;
  add_headings(all);
  add_places(all);
  add_speeds(all);
  add_times(all);
  add_waypoints(all);
  add_resets(all);
  add_actuators(all);
  return all;
}

std::shared_ptr<SignalMemory> remember(run::ClosedLoop& loop, std::uint64_t seed) {
  auto memory = std::make_shared<SignalMemory>(seed, loop.scenario().vehicle.scale);
  loop.intercept({.measured = [memory](Measurement& now) { memory->add(now); }});
  return memory;
}

void make_false(run::ClosedLoop& loop, const FalseSignal& signal, std::shared_ptr<SignalMemory> memory,
                double duration) {
  constexpr double kRounding = 1e-9;  // [s] sums of step lengths round
  const double end = loop.time() + duration - kRounding;
  memory->began = loop.time();
  memory->kept.reset();
  run::Interceptor interceptor;
  interceptor.measured = [memory, end, change = signal.measured](Measurement& now) {
    memory->add(now);
    if (change && now.time < end) change(*memory, now);
  };
  if (signal.actuated)
    interceptor.actuated = [end, change = signal.actuated](double time, model::Command& command) {
      if (time < end) change(command);
    };
  loop.intercept(std::move(interceptor));
  if (signal.put_on_lap < 0.0) return;
  const road::Track& track = loop.track();
  const road::PathPoint point = track.centre().at(track.start_s() + signal.put_on_lap * track.lap_length());
  loop.put_car({.x = point.position.x(), .y = point.position.y(), .psi = point.heading});
}

}  // namespace chicane::attack
