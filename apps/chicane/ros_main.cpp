// SPDX-License-Identifier: MIT
// The program chicane-ros, which `chicane ros` becomes: the only one that needs DDS.
#include <vector>

#include "program.hpp"
#include "ros_node.hpp"

int main(int count, char** words) {
  std::vector<const char*> command{"chicane", "ros"};
  command.insert(command.end(), words + (count > 0 ? 1 : 0), words + count);
  return chicane::apps::program(static_cast<int>(command.size()), command.data(), chicane::apps::ros_node);
}
