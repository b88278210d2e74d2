// SPDX-License-Identifier: MIT
#pragma once

#include "options.hpp"

namespace CLI {
class App;
}

/// The options of each command, by its name.
namespace chicane::apps {

void add_drive(CLI::App& command, Options& options);
void add_serve(CLI::App& command, Options& options);
void add_simulate(CLI::App& command, Options& options);
void add_ros(CLI::App& command, Options& options);
void add_limit(CLI::App& command, Options& options);
void add_replay(CLI::App& command, Options& options);
void add_report(CLI::App& command, Options& options);
void add_video(CLI::App& command, Options& options);
void add_sweep(CLI::App& command, Options& options);
void add_league(CLI::App& command, Options& options);
void add_claims(CLI::App& command, Options& options);
void add_tune(CLI::App& command, Options& options);
void add_merge(CLI::App& command, Options& options);
void add_campaign(CLI::App& command, Options& options);
void add_recover(CLI::App& command, Options& options);
void add_lane_change(CLI::App& command, Options& options);
void add_import(CLI::App& command, Options& options);
void add_identify(CLI::App& command, Options& options);
void add_check(CLI::App& command, Options& options);
void add_list(CLI::App& command, Options& options);
void add_bench(CLI::App& command, Options& options);
void add_completion(CLI::App& command, Options& options);
void add_manual(CLI::App& command, Options& options);

}  // namespace chicane::apps
