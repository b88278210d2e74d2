// SPDX-License-Identifier: MIT
// Random problems of any shape, most of them unpleasant: scales, bounds, functions that are not numbers,
// jumps. Each answer of the solver is judged by a check that shares no line with it.
//
//   chicane-solver-fuzz [COUNT [FIRST [NAME]]]     COUNT solves, default 100000; FIRST: seed of the first
//   one, default 0; NAME: problems whose name contains it, default all
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "fuzz/list.hpp"

int main(int argc, char** argv) {
  using namespace chicane::bench;
  const long count = argc > 1 ? std::atol(argv[1]) : 100000;
  const long first = argc > 2 ? std::atol(argv[2]) : 0;
  const std::string_view wanted = argc > 3 ? argv[3] : "";
  std::vector<FuzzKind> kinds;
  for (const FuzzKind& kind : all_fuzz_kinds()) {
    if (std::string_view(kind.name).find(wanted) != std::string_view::npos) kinds.push_back(kind);
  }
  if (kinds.empty()) {
    std::fprintf(stderr, "no problem is named like that\n");
    return 2;
  }
  FuzzTally total;
  std::printf("%-28s %8s %8s %8s %8s %8s %8s %8s %6s %8s\n", "problem", "solves", "optimal", "floor",
              "budget", "stalled", "infeas.", "no number", "wrong", "slowest");
  for (std::size_t n = 0; n < kinds.size(); ++n) {
    const long share = count / static_cast<long>(kinds.size());
    const FuzzTally tally = kinds[n].run(share, first);
    print(kinds[n].name, tally);
    total.add(tally);
  }
  print("all", total);
  return total.wrong == 0 ? 0 : 1;
}
