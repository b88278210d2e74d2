// SPDX-License-Identifier: MIT
// The program chicane-lab, which `chicane` becomes for the commands of many runs, logs and reports: a lap
// needs none of their libraries.
#include "commands.hpp"
#include "program.hpp"

int main(int count, char** words) {
  return chicane::apps::program(count, words, chicane::apps::do_command<true>);
}
