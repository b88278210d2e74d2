// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "chicane/wire/serve.hpp"
#include "net/recorder.hpp"
#include "support/borrowed.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {

using wire::Router;
using wire::ServeHooks;
using wire::ServeOptions;
using wire::ServeSummary;
using wire::UdacityEndpoint;

/// Always the same command where anything was measured; remembers what it was told.
class FixedController final : public controller::Controller {
 public:
  const controller::StepResult& step(const model::Measurement& now, Deadline) noexcept override {
    const std::lock_guard lock(mutex_);
    result_.answer = std::isfinite(now.x) ? controller::Answer::kDrive : controller::Answer::kNone;
    result_.command = {.steer = 0.1, .throttle = 0.5};
    last_ = now;
    ++steps_;
    return result_;
  }
  void reset() noexcept override {
    const std::lock_guard lock(mutex_);
    ++resets_;
  }
  [[nodiscard]] std::string_view name() const noexcept override { return "fixed"; }

  [[nodiscard]] model::Measurement last() { return locked(last_); }
  [[nodiscard]] int resets() { return locked(resets_); }
  [[nodiscard]] int steps() { return locked(steps_); }

 private:
  template <class Value>
  Value locked(const Value& value) {
    const std::lock_guard lock(mutex_);
    return value;
  }

  std::mutex mutex_;
  model::Measurement last_;
  int resets_ = 0;
  int steps_ = 0;
  controller::StepResult result_;
};

/// A served endpoint with a page beside it, and the lines it logs.
class Served {
 public:
  explicit Served(ServeOptions options = immediate()) {
    options.server.port = 0;
    ServeHooks hooks;
    hooks.on_clock = hooks.log = [this](std::string_view line) { note(line); };
    endpoint_ =
        std::make_unique<UdacityEndpoint>(options, std::make_unique<Borrowed>(controller), std::move(hooks));
    router_ = std::make_unique<Router>(endpoint_.get(), nullptr);
    auto created =
        net::Server::create(options.server, router_->handlers(),
                            {{.path = "/index.html", .content_type = "text/html", .content = "the page"}});
    if (created) server_ = std::move(*created);
  }
  /// With one option that is not as immediate() has it.
  template <class Part, class Value>
  Served(Value Part::*option, std::type_identity_t<Value> value) : Served(with(option, value)) {}
  void stop() { endpoint_->stop(); }
  ~Served() {
    stop();
    server_.reset();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  template <class Part, class Value>
  static ServeOptions with(Value Part::*option, std::type_identity_t<Value> value) {
    ServeOptions options = immediate();
    options.*option = value;
    return options;
  }
  static ServeOptions immediate() {
    ServeOptions options;
    options.latency = std::chrono::nanoseconds{0};
    options.open_after = options.quiet_after = options.silent_after = std::chrono::minutes{1};
    return options;
  }

  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  [[nodiscard]] ServeSummary summary() const { return endpoint_->summary(); }

  /// A client that has sent the original's upgrade request and got its 101.
  [[nodiscard]] RawSocket connect() const { return upgraded(port()); }

  /// Waits for a logged line that contains `words`.
  [[nodiscard]] bool has_logged(std::string_view words) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds{10},
                             [&] { return log_.find(words) != std::string::npos; });
  }

  FixedController controller;

 private:
  void note(std::string_view line) {
    const std::lock_guard lock(mutex_);
    log_ += std::string(line) + "\n";
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::string log_;
  std::unique_ptr<UdacityEndpoint> endpoint_;
  std::unique_ptr<Router> router_;
  std::unique_ptr<net::Server> server_;
};

/// The data of a complete, finite steer reply; a failure otherwise.
inline nlohmann::json steer_of(const std::optional<RawSocket::Frame>& frame) {
  if (!frame || frame->opcode != 1 || !frame->payload.starts_with("42[\"steer\",")) {
    ADD_FAILURE() << (frame ? frame->payload : "no answer");
    return {};
  }
  nlohmann::json data = nlohmann::json::parse(frame->payload.substr(2))[1];
  for (const char* key : {"mpc_x", "mpc_y", "next_x", "next_y"}) {
    EXPECT_TRUE(data.at(key).is_array()) << frame->payload;
  }
  for (const char* key : {"steering_angle", "throttle"}) {
    EXPECT_TRUE(data.at(key).is_number()) << frame->payload;
    EXPECT_LE(std::abs(data.at(key).get<double>()), 1.0) << frame->payload;
  }
  return data;
}

}  // namespace chicane::test
