// SPDX-License-Identifier: MIT
#include "commands.hpp"
#include "program.hpp"

int main(int count, char** words) {
  return chicane::apps::program(count, words, chicane::apps::do_command<false>);
}
