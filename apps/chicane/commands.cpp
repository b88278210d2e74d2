// SPDX-License-Identifier: MIT
#include "commands.hpp"

#include <cstdio>

namespace chicane::apps {
namespace {

constexpr Command kCommands[] = {
    {"drive", "Drive", "Controller and simulator in one process, with a dashboard",
     "chicane drive --preset sixty-mph --track lakeside --laps 2 --fast", drive, drive_rows, true},
    {"serve", "Drive", "Controller for an external simulator, as the original program was",
     "chicane serve --preset weighted --port 4567", serve, serve_rows, true},
    {"simulate", "Drive", "Simulator for an external controller, as the original game was",
     "chicane simulate --connect ws://127.0.0.1:4567 --track lakeside --laps 2", simulate, simulate_rows},
    {"replay", "Look", "Show recorded runs, verify them bit for bit, or drive on from within one",
     "chicane replay run.mcap --branch-at 12 --set plant_options.friction_scale=0.5", replay, replay_rows,
     true},
    {"report", "Look", "Recorded runs as one HTML page that needs nothing else",
     "chicane report run.mcap -o run.html", in_lab, report_rows},
    {"video", "Look", "Recorded lap as a film, with the ghost of another one",
     "chicane video run.mcap -o lap.mp4 --ghost other.mcap", in_lab, video_rows},
    {"limit", "Compare", "Fastest lap and racing line of a car on a track",
     "chicane limit --track lakeside --car road-car --csv line.csv", limit, limit_rows, true},
    {"league", "Compare", "Controllers and programs compared on tracks, in cars and disturbances",
     "chicane league studies/leagues/shipped.yaml -o league.html", in_lab, league_rows, true},
    {"sweep", "Compare", "Many runs from one plan, on many threads and machines",
     "chicane sweep studies/plans/speed-and-latency.yaml --jobs 4", in_lab, sweep_rows, true},
    {"merge", "Compare", "Results of the parts of a sweep as one file",
     "chicane merge results.*-of-*.jsonl -o results.jsonl", in_lab, merge_rows},
    {"tune", "Compare", "Fastest clean tuning of a preset, searched",
     "chicane tune --preset weighted --evaluations 2000 -o tuned.yaml", in_lab, tune_rows, true},
    {"campaign", "Prove", "Faults at every moment of a lap: where the car leaves the road",
     "chicane campaign --pairs --onsets 3 --for-s 1,2,inf --preset default,race --tracks all --results "
     "campaign.jsonl",
     in_lab, campaign_rows, true},
    {"recover", "Prove", "Recovery from anywhere beside the road: whether the car comes back",
     "chicane recover --tracks lakeside,oval --starts 120", in_lab, recover_rows, true},
    {"lane-change", "Prove", "Highest entry speed of the severe double lane change, ISO 3888-2",
     "chicane lane-change --cars road-car --presets default,stanley", in_lab, lane_change_rows},
    {"claims", "Prove", "Claims of five write-ups, each tried on its own terms", "chicane claims B7 D9",
     in_lab, claims_rows, true},
    {"bench", "Prove", "Times of solver and control step on this machine, beside Ipopt's",
     "chicane bench --instances 200 --horizons 10,20", bench, bench_rows},
    {"check", "Tools", "Validate scenarios, presets, cars and tracks, and explain what is wrong",
     "chicane check data/presets/weighted.yaml data/tracks/lakeside.csv --car road-car", check, check_rows,
     true},
    {"list", "Tools", "Presets, tracks, cars, scenarios, controllers and parameters", "chicane list presets",
     list, list_rows},
    {"import", "Tools", "Road from a map, cones, coordinates or another program's file",
     "chicane import map.yaml -o hall.csv --preview hall.html", in_lab, import_rows},
    {"identify", "Tools", "Model of a car from logs of driving it",
     "chicane identify run.mcap --car road-car -o mine.yaml", in_lab, identify_rows},
    {"ros", "Tools", "Controller as a ROS 2 node without ROS, or the simulator for one",
     "chicane ros --car f1tenth --track oval --domain 7", ros, ros_rows, true},
    {"completion", "Tools", "Script that completes command lines, for bash, zsh or fish",
     "source <(chicane completion bash)", completion, completion_rows},
    {"manual", "Tools", "Manual page, as roff", "chicane manual | man -l -", manual, nullptr},
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

Rows options_of(const Command& command, Options& options) {
  Rows rows = command.rows == nullptr ? Rows{} : command.rows(options);
  if (command.is_planning)
    rows.push_back({"--no-cache", "", "Compute plans and limits again, and keep none in the cache folder",
                    Off{&options.uses_cache}});
  return rows;
}

ExitCode report(const Error& error) {
  print_sentence(stderr, error.message);
  return error.code == ErrorCode::kIo ? kEnvironment : kUsage;
}

}  // namespace chicane::apps
