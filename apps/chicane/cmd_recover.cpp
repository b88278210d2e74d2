// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "chicane/base/angle.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/run/way_back.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

using run::WayBackOutcome;

/// All starts of one car on one track.
struct CarOnTrack {
  std::string track, car;
  std::vector<WayBackOutcome> outcomes{};

  [[nodiscard]] auto back() const {
    return std::count_if(outcomes.begin(), outcomes.end(),
                         [](const WayBackOutcome& each) { return each.has_come_back(); });
  }
};

std::string_view kind_of(const WayBackOutcome& outcome) {
  return run::kStartKindNames[static_cast<std::size_t>(outcome.start.kind)];
}

std::string verdict(const WayBackOutcome& outcome) {
  if (outcome.least_edge < 0.0) return fmt::format("leaves it again by {:.2f} m", -outcome.least_edge);
  if (!(outcome.back < run::WayBackOutcome::kNever)) return "does not come back";
  return "comes back, and does not drive on";
}

/// The command that drives one start again.
std::string command_of(const Options& options, const CarOnTrack& pair, std::size_t index) {
  std::string text =
      fmt::format("chicane recover --tracks {} --cars {} --starts {} --seed {} --only {}", pair.track,
                  pair.car, options.recover.starts, options.recover.seed, index + 1);
  for (const auto& [key, value] : options.settings) text += fmt::format(" --set {}={}", key, value);
  return text;
}

std::size_t number_of(const Options& options, std::size_t index) {
  return options.recover.only > 0 ? static_cast<std::size_t>(options.recover.only) - 1 : index;
}

void print_table(const Options& options, const std::vector<CarOnTrack>& pairs) {
  fmt::print("{:<10} {:<10} {:<10} {:>7} {:>5} {:>14} {:>14} {:>12}\n", "track", "car", "start", "starts",
             "back", "back [s]", "lapping [s]", "farthest [m]");
  for (const CarOnTrack& pair : pairs) {
    for (const std::string_view kind : run::kStartKindNames) {
      int starts = 0;
      int back = 0;
      double slowest_back = 0.0, slowest = 0.0, farthest = 0.0;
      for (const WayBackOutcome& each : pair.outcomes) {
        if (kind_of(each) != kind) continue;
        ++starts;
        farthest = std::max(farthest, each.farthest);
        if (!each.has_come_back()) continue;
        ++back;
        slowest_back = std::max(slowest_back, each.back);
        slowest = std::max(slowest, each.lapping);
      }
      if (starts == 0) continue;
      fmt::print("{:<10} {:<10} {:<10} {:>7} {:>5} {:>14.1f} {:>14.1f} {:>12.1f}\n", pair.track, pair.car,
                 kind, starts, back, slowest_back, slowest, farthest);
    }
  }
  for (const CarOnTrack& pair : pairs) {
    for (std::size_t i = 0; i < pair.outcomes.size(); ++i) {
      const WayBackOutcome& each = pair.outcomes[i];
      if (each.has_come_back()) continue;
      fmt::print("\n{} {}, start {}, {}: {}\n  {}\n", pair.track, pair.car, number_of(options, i) + 1,
                 kind_of(each), verdict(each), command_of(options, pair, number_of(options, i)));
    }
  }
}

protocol::Json time_or_null(double time) {
  return std::isfinite(time) ? protocol::Json(time) : protocol::Json();
}

void print_json(const Options& options, const std::vector<CarOnTrack>& pairs) {
  protocol::Json all = protocol::Json::array();
  for (const CarOnTrack& pair : pairs) {
    protocol::Json each = protocol::Json::array();
    for (std::size_t i = 0; i < pair.outcomes.size(); ++i) {
      const WayBackOutcome& outcome = pair.outcomes[i];
      const model::State& start = outcome.start.state;
      each.push_back({{"number", number_of(options, i) + 1},
                      {"start", kind_of(outcome)},
                      {"x_m", start.x},
                      {"y_m", start.y},
                      {"yaw_deg", radians_to_degrees(start.psi)},
                      {"vx_mps", start.vx},
                      {"vy_mps", start.vy},
                      {"yaw_rate_degps", radians_to_degrees(start.r)},
                      {"is_back", outcome.has_come_back()},
                      {"back_s", time_or_null(outcome.back)},
                      {"lapping_s", time_or_null(outcome.lapping)},
                      {"farthest_m", outcome.farthest},
                      {"least_edge_m", time_or_null(outcome.least_edge)}});
    }
    all.push_back({{"track", pair.track},
                   {"car", pair.car},
                   {"starts", pair.outcomes.size()},
                   {"back", pair.back()},
                   {"outcomes", std::move(each)}});
  }
  fmt::print("{}\n",
             protocol::json_text(protocol::Json{{"rows", std::move(all)}}, protocol::JsonLayout::kIndented));
}

Result<CarOnTrack> drive_starts(const Options& options, const std::string& track, const std::string& car,
                                const std::atomic<bool>& wants_stop) {
  auto settings = options.settings;
  settings.emplace_back("track", track);
  settings.emplace_back("car", car);
  const Result<scenario::Scenario> scenario = protocol::compose({"", settings});
  if (!scenario) return fail(scenario.error());
  const Result<path::Track> road = run::make_track(*scenario);
  if (!road) return fail(road.error());
  auto starts = run::start_poses(*road, options.recover.starts, options.recover.seed);
  if (options.recover.only > 0) {
    const auto only = static_cast<std::size_t>(options.recover.only);
    if (only > starts.size()) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("--only: got {}, expected a start from 1 to {}", only, starts.size()));
    }
    starts = {starts[only - 1]};
  }
  auto outcomes = run::drive_all_back(*scenario, starts, run::threads_for(options.jobs),
                                      [&](std::size_t) { return !wants_stop; });
  if (!outcomes) return fail(outcomes.error());
  return CarOnTrack{track, car, std::move(*outcomes)};
}

Result<std::vector<CarOnTrack>> recover_all(const Options& options, const std::atomic<bool>& wants_stop) {
  std::vector<CarOnTrack> pairs;
  for (const std::string& track : options.recover.tracks) {
    for (const std::string& car : options.recover.cars) {
      if (wants_stop) return pairs;
      Result<CarOnTrack> pair = drive_starts(options, track, car, wants_stop);
      if (!pair) return fail(pair.error());
      if (isatty(STDERR_FILENO) != 1)
        fmt::print(stderr, "{} {}: {} of {} back\n", track, car, pair->back(), pair->outcomes.size());
      pairs.push_back(std::move(*pair));
    }
  }
  return pairs;
}

}  // namespace

ExitCode recover(const Options& options) {
  keep_memory();
  static std::atomic<bool> wants_stop{false};  // static: must outlive the last signal
  catch_interrupts(wants_stop);
  const Result<std::vector<CarOnTrack>> pairs = recover_all(options, wants_stop);
  if (!pairs) return report(pairs.error());
  if (options.is_json) {
    print_json(options, *pairs);
  } else {
    print_table(options, *pairs);
  }
  const bool are_all_back = std::all_of(pairs->begin(), pairs->end(), [](const CarOnTrack& pair) {
    return static_cast<std::size_t>(pair.back()) == pair.outcomes.size();
  });
  return are_all_back ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
