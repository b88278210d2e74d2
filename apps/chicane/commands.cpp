// SPDX-License-Identifier: MIT
#include "commands.hpp"

#include <cstdio>

#include "command_options.hpp"

namespace chicane::apps {
namespace {

constexpr Command kCommands[] = {
    {"drive", "Drive", "Controller and simulator in one process, with a dashboard", drive, add_drive, true},
    {"serve", "Drive", "Controller for an external simulator, as the original program was", serve, add_serve,
     true},
    {"simulate", "Drive", "Simulator for an external controller, as the original game was", simulate,
     add_simulate},
    {"replay", "Look", "Show recorded runs, verify them bit for bit, or drive on from within one", replay,
     add_replay, true},
    {"report", "Look", "Recorded runs as one HTML page that needs nothing else", in_lab, add_report},
    {"video", "Look", "Recorded lap as a film, with the ghost of another one", in_lab, add_video},
    {"limit", "Compare", "Fastest lap and racing line of a car on a track", limit, add_limit, true},
    {"league", "Compare",
     "Controllers and programs on tracks, in cars and disturbances, compared on one page", in_lab, add_league,
     true},
    {"sweep", "Compare", "Many runs from one plan, on many threads and machines", in_lab, add_sweep, true},
    {"merge", "Compare", "Results of the parts of a sweep as one file", in_lab, add_merge},
    {"tune", "Compare", "Fastest clean tuning of a preset, searched", in_lab, add_tune, true},
    {"campaign", "Prove", "Faults at every moment of a lap: where the car leaves the road", in_lab,
     add_campaign, true},
    {"recover", "Prove", "Recovery from anywhere beside the road: whether the car comes back", in_lab,
     add_recover, true},
    {"lane-change", "Prove", "Highest entry speed of the severe double lane change, ISO 3888-2", in_lab,
     add_lane_change},
    {"claims", "Prove", "Claims of five write-ups, each tried on its own terms", in_lab, add_claims, true},
    {"bench", "Prove", "Times of solver and control step on this machine, beside Ipopt's", bench, add_bench},
    {"check", "Tools", "Validate scenarios, presets, cars and tracks, and explain what is wrong", check,
     add_check, true},
    {"list", "Tools", "Presets, tracks, cars, scenarios, controllers and parameters", list, add_list},
    {"import", "Tools", "Road from a map, cones, coordinates or another program's file", in_lab, add_import},
    {"identify", "Tools", "Model of a car from logs of driving it", in_lab, add_identify},
    {"ros", "Tools", "Controller as a ROS 2 node without ROS, or the simulator for one", ros, add_ros, true},
    {"completion", "Tools", "Script that completes command lines, for bash, zsh or fish", completion,
     add_completion},
    {"manual", "Tools", "Manual page, as roff", manual, add_manual},
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

ExitCode report(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return error.code == ErrorCode::kIo ? kEnvironment : kUsage;
}

}  // namespace chicane::apps
