// SPDX-License-Identifier: MIT
// The program chicane. Commands of many runs, logs and reports are those of chicane-lab (lab/main.cpp).
#include "commands.hpp"
#include "program.hpp"

int main(int count, char** words) {
  return chicane::apps::program(count, words, chicane::apps::do_command<false>);
}
