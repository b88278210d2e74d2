// SPDX-License-Identifier: MIT
// Ctrl-C while `chicane bench` measures.
#include <sys/wait.h>
#include <unistd.h>

#include "support/chicane_test.hpp"

namespace chicane::bench {
namespace {

TEST(ChicaneBench, EndsWithTheResultsSoFarWhenInterrupted) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("chicane_bench_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const std::string out = "'" + (folder / "out").string() + "'",
                    said = "'" + (folder / "said").string() + "'";
  const std::string command = "'" CHICANE_PROGRAM "' bench --json > " + out + " 2> " + said +
                              " & program=$!; while kill -0 $program && ! grep -q instances " + said +
                              "; do sleep 0.05; done; kill -INT $program; wait $program";
  const int status = std::system(command.c_str());  // NOLINT(cert-env33-c): as a terminal does it
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0);
  std::ostringstream report;
  report << std::ifstream(folder / "out").rdbuf();
  EXPECT_NE(report.str().find("\"interrupted\": true"), std::string::npos) << report.str();
  fs::remove_all(folder);
}

}  // namespace
}  // namespace chicane::bench
