// SPDX-License-Identifier: MIT
#include "commands.hpp"

#include <cstdio>

namespace chicane::apps {
namespace {

constexpr Command kCommands[] = {
    {"drive", "Controller and simulator in one process, with a dashboard", drive},
    {"serve", "Controller for an external simulator, as the original program was", serve},
    {"simulate", "Simulator for an external controller, as the original game was", simulate},
    {"ros", "Controller as a ROS 2 node without ROS, or the simulator for one", ros},
    {"limit", "Fastest lap and racing line of a car on a track", limit},
    {"replay", "Show recorded runs, verify them bit for bit, or drive on from within one", replay},
    {"report", "Recorded runs as one HTML page that needs nothing else", report_logs},
    {"video", "A recorded lap as a film, with the ghost of another one", make_video},
    {"sweep", "Many runs from one plan, on many threads and machines", drive_sweep},
    {"merge", "Results of the parts of a sweep as one file", merge_results},
    {"tune", "The fastest clean tuning of a preset, searched", tune},
    {"league", "Controllers and programs on tracks, in cars and disturbances, compared on one page",
     compare_league},
    {"campaign", "Faults at every moment of a lap: where the car leaves the road", campaign},
    {"recover", "From anywhere beside the road: whether the car comes back", recover},
    {"lane-change", "Highest entry speed of the severe double lane change, ISO 3888-2", lane_change},
    {"claims", "What five write-ups say, each tried on its own terms", try_claims},
    {"identify", "A car's model from logs of driving it", identify_car},
    {"check", "Validate scenarios, presets, cars and tracks, and explain what is wrong", check},
    {"list", "Presets, tracks, cars, scenarios, controllers and parameters", list},
    {"bench", "Times of solver and control step on this machine, beside Ipopt's", bench},
    {"completion", "Script that completes command lines, for bash, zsh or fish", completion},
    {"manual", "Manual page, as roff", manual},
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

ExitCode report(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return error.code == ErrorCode::kIo ? kEnvironment : kUsage;
}

}  // namespace chicane::apps
