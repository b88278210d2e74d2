// SPDX-License-Identifier: MIT
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <variant>

#include "commands.hpp"

namespace chicane::apps {
namespace {

constexpr Command kCommands[] = {
    {"drive", "Controller and simulator in one process, with a dashboard", drive},
    {"serve", "Controller for an external simulator, as the original program was", serve},
    {"simulate", "Simulator for an external controller, as the original game was", simulate},
    {"replay", "Compute a recorded run again and compare every command, bit for bit", replay},
    {"check", "Validate scenarios, presets, cars and tracks, and explain what is wrong", check},
    {"list", "Presets, tracks, cars, scenarios, controllers and parameters", list},
    {"bench", "Times of solver and control step on this machine, beside Ipopt's", bench},
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

ExitCode report(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return error.code == ErrorCode::kIo ? kEnvironment : kUsage;
}

}  // namespace chicane::apps

int main(int count, char** words) {
  using namespace chicane::apps;
  try {
    const std::variant<Options, Done> parsed = parse_command_line(count, words);
    if (const Done* done = std::get_if<Done>(&parsed)) return done->code;
    const Options& options = std::get<Options>(parsed);
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
