// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "options.hpp"

namespace CLI {
class App;
}

namespace chicane::apps {

struct Command {
  std::string_view name;
  std::string_view group;  ///< heading in the help
  std::string_view summary;
  ExitCode (*run)(const Options&) = nullptr;
  void (*add_options)(CLI::App& command, Options& options) = nullptr;
  bool is_planning = false;  ///< it plans laps or finds limits, which it may keep
};

/// All commands, in the order of the help, group by group.
[[nodiscard]] std::span<const Command> commands();

[[nodiscard]] ExitCode drive(const Options& options);
[[nodiscard]] ExitCode serve(const Options& options);
[[nodiscard]] ExitCode simulate(const Options& options);
/// Becomes the program chicane-ros (ros_main.cpp); kUsage where that is not installed.
[[nodiscard]] ExitCode ros(const Options& options);
[[nodiscard]] ExitCode limit(const Options& options);
[[nodiscard]] ExitCode replay(const Options& options);
[[nodiscard]] ExitCode import_road(const Options& options);
[[nodiscard]] ExitCode identify_car(const Options& options);
[[nodiscard]] ExitCode report_logs(const Options& options);
[[nodiscard]] ExitCode make_video(const Options& options);
[[nodiscard]] ExitCode drive_sweep(const Options& options);
[[nodiscard]] ExitCode merge_results(const Options& options);
[[nodiscard]] ExitCode try_claims(const Options& options);
[[nodiscard]] ExitCode compare_league(const Options& options);
[[nodiscard]] ExitCode tune(const Options& options);
[[nodiscard]] ExitCode campaign(const Options& options);
[[nodiscard]] ExitCode recover(const Options& options);
[[nodiscard]] ExitCode lane_change(const Options& options);
[[nodiscard]] ExitCode check(const Options& options);
[[nodiscard]] ExitCode list(const Options& options);
/// What `chicane list` takes.
[[nodiscard]] std::vector<std::string> list_names();
/// Becomes the program chicane-bench (bench/program); kEnvironment where that is not built.
[[nodiscard]] ExitCode bench(const Options& options);
[[nodiscard]] ExitCode completion(const Options& options);
[[nodiscard]] ExitCode manual(const Options& options);

/// Says the error on stderr; which exit code it is.
[[nodiscard]] ExitCode report(const Error& error);

}  // namespace chicane::apps
