// SPDX-License-Identifier: MIT
// The real controller behind the real server on any free port, for stock clients: prints "port N", ends with
// its input.
#include <cstdio>
#include <iostream>
#include <string>
#include <string_view>

#include "chicane/run/make.hpp"
#include "chicane/wire/serve.hpp"

int main() {
  using namespace chicane;
  const scenario::Scenario scenario;
  auto controller = run::make_controller(scenario);
  if (!controller) {
    std::cerr << controller.error().message << '\n';
    return 2;
  }
  wire::ServeOptions options;
  wire::ServeHooks hooks;
  hooks.log = [](std::string_view line) { std::cerr << line << std::endl; };
  wire::UdacityEndpoint endpoint(options, std::move(*controller), std::move(hooks));
  wire::Router router(&endpoint, nullptr);
  options.server.port = 0;
  auto server = net::Server::create(options.server, router.handlers(), {});
  if (!server) {
    std::cerr << server.error().message << '\n';
    return 3;
  }
  std::cout << "port " << (*server)->port() << std::endl;
  while (std::cin.get() != std::char_traits<char>::eof()) {
  }
  endpoint.stop();
  server->reset();
  return 0;
}
