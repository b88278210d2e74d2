// SPDX-License-Identifier: MIT
// Many runs in one program: the longest actuation delay with which the controller stays on the road, with and
// without compensation.
#include <cstdio>
#include <string>

#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"

namespace {

/// "28.1 s" for a clean run of two laps, otherwise the reason.
std::string flying_lap(const std::string& latency_ms, const std::string& compensate) {
  const auto scenario = chicane::protocol::compose(
      {.scenario_file = "first-lap",
       .settings = {{"latency_ms", latency_ms}, {"tracking_mpc.compensate_delay", compensate}}});
  if (!scenario) return scenario.error().message;
  const auto loop = chicane::run::ClosedLoop::create(*scenario);
  if (!loop) return loop.error().message;
  const auto run = chicane::run::run_closed_loop(**loop);
  if (!chicane::telemetry::completed_on_road(run)) return "left the road";
  return std::to_string(run.laps.back().lap_time).substr(0, 5) + " s";
}

}  // namespace

int main() {
  std::puts("delay [ms]   compensated     not compensated");
  for (const char* latency : {"0", "50", "100", "200", "300"}) {
    std::printf("%10s   %-15s %s\n", latency, flying_lap(latency, "true").c_str(),
                flying_lap(latency, "false").c_str());
  }
  return 0;
}
