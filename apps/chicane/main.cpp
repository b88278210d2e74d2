// SPDX-License-Identifier: MIT
#include "commands.hpp"
#include "program.hpp"

int main(int count, char** words) {
  using namespace chicane::apps;
  return program(count, words, [](const Options& options) {
    for (const Command& command : commands())
      if (command.name == options.command) return command.run(options);
    return kUsage;
  });
}
