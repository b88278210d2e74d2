// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <string>
#include <vector>

#include "commands.hpp"
#include "other_program.hpp"

namespace chicane::apps {
namespace {

/// The options in full, as bench/program/request.hpp reads them.
std::vector<std::string> words_of(const Options& options) {
  std::vector<std::string> words{"--instances", std::to_string(options.instances), "--horizons",
                                 fmt::format("{}", fmt::join(options.horizons, ","))};
  if (!options.reference_folder.empty()) words.insert(words.end(), {"--reference", options.reference_folder});
  if (options.is_json) words.emplace_back("--json");
  return words;
}

}  // namespace

ExitCode bench(const Options& options) {
  const std::string program = other_program("chicane-bench", false);
  if (program.empty()) {
    fmt::print(stderr,
               "chicane bench: chicane-bench, the program that measures, is not built (looked in {}).\n"
               "In a clone `./run.sh bench` builds it; in a build folder `cmake --build . --target "
               "chicane_bench`.\n",
               own_folder());
    return kEnvironment;
  }
  fmt::print(stderr, "{}\n", become(program, words_of(options)));
  return kEnvironment;
}

}  // namespace chicane::apps
