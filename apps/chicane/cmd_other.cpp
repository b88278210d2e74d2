// SPDX-License-Identifier: MIT
// Commands that are programs of their own, so that no other command waits for what they need.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "commands.hpp"
#include "other_program.hpp"

namespace chicane::apps {
namespace {

/// The options in full, as bench/program/request.hpp reads them.
std::vector<std::string> words_for_bench(const Options& options) {
  std::vector<std::string> words{"--instances", std::to_string(options.instances), "--horizons",
                                 fmt::format("{}", fmt::join(options.horizons, ","))};
  if (!options.reference_folder.empty()) words.insert(words.end(), {"--reference", options.reference_folder});
  if (options.is_json) words.emplace_back("--json");
  return words;
}

ExitCode become_or_say_why(const std::string& program, std::vector<std::string> words) {
  fmt::print(stderr, "{}\n", become(program, std::move(words)));
  return kEnvironment;
}

ExitCode say_how_to_build(const std::string& command, std::string_view program, std::string_view meaning,
                          std::string_view target) {
  fmt::print(stderr,
             "chicane {0}: {1}, the program {2}, is not built (looked in {4}).\n"
             "In a clone `./run.sh {0}` builds it; in a build folder `cmake --build . --target {3}`.\n",
             command, program, meaning, target, own_folder());
  return kEnvironment;
}

}  // namespace

ExitCode ros(const Options& options) {
  const std::string program = other_program("chicane-ros", true);
  if (!program.empty()) return become_or_say_why(program, options.words);
  fmt::print(stderr,
             "chicane ros: the program chicane-ros is not there: install it (apt install "
             "./chicane-ros_*.deb, in a clone ./run.sh ros)\n");
  return kUsage;
}

ExitCode bench(const Options& options) {
  const std::string program = other_program("chicane-bench", false);
  if (!program.empty()) return become_or_say_why(program, words_for_bench(options));
  return say_how_to_build("bench", "chicane-bench", "that measures", "chicane_bench");
}

ExitCode in_lab(const Options& options) {
  const std::string program = other_program("chicane-lab", false);
  if (program.empty())
    return say_how_to_build(options.command, "chicane-lab", "of many runs, logs and reports", "chicane_lab");
  std::vector<std::string> words{options.command};
  words.insert(words.end(), options.words.begin(), options.words.end());
  return become_or_say_why(program, std::move(words));
}

}  // namespace chicane::apps
