// SPDX-License-Identifier: MIT
// The program chicane-lab, which `chicane` becomes for the commands of many runs, logs and reports: a lap
// needs none of their libraries.
#include <string_view>

#include "commands.hpp"
#include "program.hpp"

namespace {

using namespace chicane::apps;

struct LabCommand {
  std::string_view name;
  ExitCode (*run)(const Options&);
};

constexpr LabCommand kCommands[] = {
    {"replay", [](const Options& options) { return replay_logs(options, convert_foreign_log); }},
    {"report", report_logs},
    {"video", make_video},
    {"league", compare_league},
    {"sweep", drive_sweep},
    {"merge", merge_results},
    {"tune", tune},
    {"campaign", campaign},
    {"recover", recover},
    {"lane-change", lane_change},
    {"claims", try_claims},
    {"import", import_road},
    {"identify", identify_car},
};

}  // namespace

int main(int count, char** words) {
  return program(count, words, [](const Options& options) {
    for (const LabCommand& command : kCommands)
      if (command.name == options.command) return command.run(options);
    return kUsage;
  });
}
