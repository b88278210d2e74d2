// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>
#include <variant>

#include "commands.hpp"
#include "references/ipopt_reference.hpp"
#ifdef CHICANE_HAVE_CPPAD
#include "references/cppad_reference.hpp"
#endif

/// `chicane bench` with all other solvers that were found; takes the same words.
int main(int count, char** words) {
  using namespace chicane;
  try {
    const auto parsed = apps::parse_command_line(count, words);
    if (const apps::Done* done = std::get_if<apps::Done>(&parsed)) return done->code;
    bench::References references;
    bench::add_ipopt(references);
#ifdef CHICANE_HAVE_CPPAD
    bench::add_cppad(references);
#endif
    return apps::measure(std::get<apps::Options>(parsed), references);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "chicane-bench: %s\n", e.what());
    return apps::kEnvironment;
  }
}
