// SPDX-License-Identifier: MIT
#include "commands.hpp"

#include <cstdio>

namespace chicane::apps {
namespace {

constexpr Command kCommands[] = {
    {"drive", "Drive", "Controller and simulator in one process, with a dashboard", drive},
    {"serve", "Drive", "Controller for an external simulator, as the original program was", serve},
    {"simulate", "Drive", "Simulator for an external controller, as the original game was", simulate},
    {"replay", "Look", "Show recorded runs, verify them bit for bit, or drive on from within one", replay},
    {"report", "Look", "Recorded runs as one HTML page that needs nothing else", report_logs},
    {"video", "Look", "Recorded lap as a film, with the ghost of another one", make_video},
    {"limit", "Compare", "Fastest lap and racing line of a car on a track", limit},
    {"league", "Compare",
     "Controllers and programs on tracks, in cars and disturbances, compared on one page", compare_league},
    {"sweep", "Compare", "Many runs from one plan, on many threads and machines", drive_sweep},
    {"merge", "Compare", "Results of the parts of a sweep as one file", merge_results},
    {"tune", "Compare", "Fastest clean tuning of a preset, searched", tune},
    {"campaign", "Prove", "Faults at every moment of a lap: where the car leaves the road", campaign},
    {"recover", "Prove", "Recovery from anywhere beside the road: whether the car comes back", recover},
    {"lane-change", "Prove", "Highest entry speed of the severe double lane change, ISO 3888-2", lane_change},
    {"claims", "Prove", "Claims of five write-ups, each tried on its own terms", try_claims},
    {"bench", "Prove", "Times of solver and control step on this machine, beside Ipopt's", bench},
    {"check", "Tools", "Validate scenarios, presets, cars and tracks, and explain what is wrong", check},
    {"list", "Tools", "Presets, tracks, cars, scenarios, controllers and parameters", list},
    {"import", "Tools", "Road from a map, cones, coordinates or another program's file", import_road},
    {"identify", "Tools", "Model of a car from logs of driving it", identify_car},
    {"ros", "Tools", "Controller as a ROS 2 node without ROS, or the simulator for one", ros},
    {"completion", "Tools", "Script that completes command lines, for bash, zsh or fish", completion},
    {"manual", "Tools", "Manual page, as roff", manual},
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

ExitCode report(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return error.code == ErrorCode::kIo ? kEnvironment : kUsage;
}

}  // namespace chicane::apps
