// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <string>

#include "commands.hpp"
#include "other_program.hpp"

namespace chicane::apps {

ExitCode ros(const Options& options) {
  const std::string program = other_program("chicane-ros", true);
  if (program.empty()) {
    fmt::print(stderr,
               "chicane ros: the program chicane-ros is not there: install it (apt install "
               "./chicane-ros_*.deb, in a clone ./run.sh ros)\n");
    return kUsage;
  }
  fmt::print(stderr, "{}\n", become(program, options.words));
  return kEnvironment;
}

}  // namespace chicane::apps
