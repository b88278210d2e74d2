// SPDX-License-Identifier: MIT
// The program chicane-bench, which `chicane bench` becomes.
#include <atomic>
#include <cstdio>

#include "commands.hpp"
#include "program.hpp"
#include "program/report.hpp"

namespace {

using namespace chicane;

std::atomic<bool> stop{false};  // set by signals, whose handler outlives each run

bench::References all_references() {
  bench::References references;
#ifdef CHICANE_HAVE_IPOPT
  bench::add_ipopt(references);
#else
  std::fputs("Built without Ipopt (Debian: coinor-libipopt-dev, then build again).\n", stderr);
#endif
#ifdef CHICANE_HAVE_PEERS
  bench::add_peers(references);
#else
  std::fputs("Built without fatrop and HPIPM (bench/README.md).\n", stderr);
#endif
  return references;
}

apps::ExitCode run(const apps::Options& options) {
  apps::catch_interrupts(stop);  // it ends with the results so far: no row takes long
  bench::References references = all_references();
  const Result<bench::BenchReport> result =
      bench::measure({.instances = options.instances, .horizons = options.horizons}, references, stop);
  if (!result) return apps::report(result.error());
  std::fputs((options.is_json ? to_json(*result) : to_markdown(*result)).c_str(), stdout);
  return apps::kSuccess;
}

}  // namespace

int main(int count, char** words) { return apps::program_of("bench", count, words, run); }
