// SPDX-License-Identifier: MIT
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <variant>

#include "chicane/base/instruction_set.hpp"
#include "commands.hpp"

int main(int count, char** words) {
  using namespace chicane::apps;
  try {
    const std::variant<Options, Done> parsed = parse_command_line(count, words);
    if (const Done* done = std::get_if<Done>(&parsed)) return done->code;
    const Options& options = std::get<Options>(parsed);
    if (const auto set = chicane::environment_instruction_set(); !set) {
      std::fprintf(stderr, "chicane: %s\n", set.error().message.c_str());
      return kUsage;
    }
    for (const Command& command : commands()) {
      if (command.name != options.command) continue;
      const ExitCode code = command.run(options);
      if (std::fflush(stdout) == 0) return code;
      std::fprintf(stderr, "chicane: the results could not be written: %s\n", std::strerror(errno));
      return kEnvironment;
    }
    return kUsage;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "chicane: %s\n", e.what());
  } catch (...) {
    std::fprintf(stderr, "chicane: unknown error\n");
  }
  return kEnvironment;
}
