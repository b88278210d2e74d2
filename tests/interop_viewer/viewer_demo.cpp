// SPDX-License-Identifier: MIT
// The viewer endpoint and the dashboard with a car on rails, for tests against real clients:
//   viewer_demo [port]   prints "listening on http://127.0.0.1:PORT/" and runs until stdin closes.
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <string_view>
#include <thread>

#include "chicane/live/pages.hpp"
#include "chicane/wire/viewer.hpp"
#include "interop_viewer/demo_drive.hpp"

namespace {

using namespace chicane;
using protocol::foxglove::Parameter;

/// Two tunables, one with a range.
class DemoParameters final : public protocol::foxglove::ParameterStore {
 public:
  std::vector<Parameter> list() const override { return {{"demo.gain", gain_}, {"demo.name", name_}}; }
  std::optional<Parameter> get(std::string_view name) const override {
    for (Parameter& parameter : list()) {
      if (parameter.name == name) return std::move(parameter);
    }
    return std::nullopt;
  }
  Result<void> set(const Parameter& parameter) override {
    const double* gain = std::get_if<double>(&parameter.value);
    if (parameter.name == "demo.gain" && gain != nullptr && *gain >= 0.0 && *gain <= 10.0) {
      gain_ = *gain;
      return {};
    }
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{}: expected a number from 0 to 10", parameter.name));
  }

 private:
  double gain_ = 1.5;
  std::string name_ = "demo";
};

/// What the network thread asks of the loop below.
struct Requests {
  std::atomic<bool> is_paused{false};
  std::atomic<int> steps{0};
  std::atomic<bool> reset{false};
};

/// What the dashboard reads of the tunables above.
constexpr std::string_view kSchema = R"([{"key": "demo.gain", "group": "demo", "kind": "number", "unit": "",
"minimum": 0, "maximum": 10, "choices": [], "default": 1.5, "meaning": "Nothing.", "is_live": true}])";

protocol::Run run_of(const road::Track& track, double period) {
  protocol::Run run;
  run.track = track.name();
  run.track_length = track.centre().length();
  run.controller = "tracking-mpc";
  run.preset = "default";
  run.latency = 0.1;
  run.control_period = period;
  run.road = protocol::road_lines(track, 2.0);
  return run;
}

bool stdin_is_closed(int wait_ms) {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char byte = 0;
  return poll(&input, 1, wait_ms) > 0 && read(STDIN_FILENO, &byte, 1) <= 0;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr double kPeriod = 0.04;
  const auto track = road::Track::create("demo road", demo::road_points(), true);
  if (!track) return fmt::print(stderr, "{}\n", track.error().message), 1;
  net::ServerOptions server_options;
  server_options.port = 0;
  if (argc > 1) {
    const std::string_view text{argv[1]};
    std::from_chars(text.data(), text.data() + text.size(), server_options.port);
  }

  Requests requests;
  DemoParameters parameters;
  wire::ViewerOptions options;
  options.run = run_of(*track, kPeriod);
  options.parameters = &parameters;
  options.services.pause = [&](bool paused) -> Result<void> {
    requests.is_paused = paused;
    return {};
  };
  options.services.step = [&]() -> Result<void> {
    if (!requests.is_paused) return fail(ErrorCode::kInvalidArgument, "/step: pause first");
    ++requests.steps;
    return {};
  };
  options.services.reset = [&]() -> Result<void> {
    requests.reset = true;
    return {};
  };
  wire::ViewerEndpoint viewer{std::move(options)};
  wire::Router router{nullptr, &viewer};
  wire::Pages pages = live::live_pages();
  pages["/schema.json"] = [] {
    return net::Content{.content_type = "application/json", .bytes = std::string{kSchema}};
  };
  const auto server =
      net::Server::create(server_options, router.handlers(std::move(pages)), live::embedded_assets());
  if (!server) return fmt::print(stderr, "{}\n", server.error().message), 3;
  fmt::print("listening on http://127.0.0.1:{}/\n", (*server)->port());
  std::fflush(stdout);

  demo::Drive drive{*track, kPeriod};
  viewer.publish(drive.frame());
  auto next = std::chrono::steady_clock::now();
  while (!stdin_is_closed(0)) {
    next += std::chrono::milliseconds{40};
    std::this_thread::sleep_until(next);
    if (requests.reset.exchange(false)) {
      drive.reset();
      viewer.publish(drive.frame());
    } else if (!requests.is_paused || requests.steps.load() > 0) {
      if (requests.is_paused) --requests.steps;
      viewer.publish(drive.step());
    }
  }
  return 0;
}
