// SPDX-License-Identifier: MIT
#include <cstdio>

int main() {
  std::puts("chicane");
  return 0;
}
