// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <nlohmann/json.hpp>

#include "chicane/wire/viewer.hpp"
#include "support/chicane_test.hpp"

namespace chicane::wire {

using json = nlohmann::json;

/// A network in memory: keeps what is sent, and runs timers when the test lets time pass.
class FakeServer final : public net::Server {
 public:
  struct Sent {
    net::ConnectionId to = 0;
    net::Bytes bytes;
    bool binary = false;
    net::Delivery delivery = net::Delivery::kReliable;
    std::uint32_t topic = 0;
  };

  using net::Server::send;
  [[nodiscard]] std::uint16_t port() const noexcept override { return 1; }
  void send(net::ConnectionId to, net::Bytes bytes, bool binary, net::Delivery delivery,
            std::uint32_t topic) override {
    sent.push_back({to, std::move(bytes), binary, delivery, topic});
  }
  void close(net::ConnectionId id, std::uint16_t, std::string_view) override { closed.push_back(id); }
  void run_after(std::chrono::nanoseconds delay, std::function<void()> task) override {
    const std::lock_guard lock(mutex);
    tasks.emplace_back(delay, std::move(task));
  }
  [[nodiscard]] std::size_t waiting(net::ConnectionId) const override { return unread; }
  /// Everything that was waiting happens, once.
  void pass_time() {
    std::unique_lock lock(mutex);
    auto due = std::exchange(tasks, {});
    lock.unlock();
    for (auto& [delay, task] : due) task();
  }
  std::vector<Sent> take() { return std::exchange(sent, {}); }

  std::vector<Sent> sent;
  std::vector<net::ConnectionId> closed;
  std::mutex mutex;  ///< of tasks: the end of a run is waited for on another thread
  std::vector<std::pair<std::chrono::nanoseconds, std::function<void()>>> tasks;
  std::size_t unread = 0;  ///< messages that wait for each connection
};

inline telemetry::Frame frame_at(double time) {
  telemetry::Frame frame;
  frame.time = time;
  return frame;
}

inline std::uint32_t channel_of(std::string_view topic) {
  const auto& topics = protocol::ros_topics();
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].name == topic) return static_cast<std::uint32_t>(i);
  }
  ADD_FAILURE() << topic;
  return 0;
}

inline std::string subscribe(std::uint32_t id, std::size_t channel) {
  return json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}}.dump();
}
inline std::string subscribe(std::uint32_t id, std::string_view topic) {
  return subscribe(id, std::size_t{channel_of(topic)});
}

inline std::uint32_t subscription_of(const FakeServer::Sent& message) {
  std::uint32_t id = 0;
  std::memcpy(&id, message.bytes->data() + 1, sizeof(id));
  return id;
}

/// Times of the messages of a subscription [s].
inline std::vector<double> times_of(const std::vector<FakeServer::Sent>& messages, net::ConnectionId to,
                                    std::uint32_t subscription) {
  std::vector<double> found;
  for (const auto& message : messages) {
    if (message.to != to || message.bytes->front() != 1 || subscription_of(message) != subscription) continue;
    std::uint64_t nanoseconds = 0;
    std::memcpy(&nanoseconds, message.bytes->data() + 5, sizeof(nanoseconds));
    found.push_back(1e-9 * static_cast<double>(nanoseconds));
  }
  return found;
}

inline std::string service_call(std::uint32_t service, std::string_view payload) {
  using namespace std::string_literals;
  std::string call = "\x02\0\0\0\0\x07\0\0\0\x03\0\0\0cdr\0\1\0\0"s;
  call[1] = static_cast<char>(service);
  return call.append(payload);
}

/// Viewer 1 is connected.
class Viewer : public testing::Test {
 protected:
  void start(ViewerOptions options) {
    endpoint = std::make_unique<ViewerEndpoint>(std::move(options));
    endpoint->on_start(server);
    connect(1, true);
  }
  void connect(net::ConnectionId id, bool may_control, const std::string& target = "/viewer") {
    net::UpgradeRequest request{.id = id, .target = target, .may_watch = true, .may_control = may_control};
    request.subprotocols = {"foxglove.sdk.v1"};
    EXPECT_TRUE(endpoint->on_upgrade(request).accept);
    endpoint->on_open(id);
  }
  /// Another one that has read what there is.
  void join(net::ConnectionId id, const std::string& target = "/viewer") {
    connect(id, false, target);
    server.take();
  }
  void say(const std::string& text, net::ConnectionId id = 1) { endpoint->on_message(id, text, false); }
  /// What is sent when time passes.
  std::vector<FakeServer::Sent> news() {
    server.pass_time();
    return server.take();
  }
  /// The only text message that has come since the last look.
  json answer() {
    const auto messages = server.take();
    if (messages.size() != 1 || messages[0].binary) {
      ADD_FAILURE() << messages.size() << " messages";
      return {};
    }
    return json::parse(*messages[0].bytes);
  }

  FakeServer server;
  std::unique_ptr<ViewerEndpoint> endpoint;
};

/// Parameters a and b; only a can be set, to positive numbers.
class Store : public protocol::foxglove::ParameterStore {
 public:
  std::vector<protocol::foxglove::Parameter> list() const override { return {{"a", a}, {"b", 2.0}}; }
  std::optional<protocol::foxglove::Parameter> get(std::string_view name) const override {
    for (auto& parameter : list()) {
      if (parameter.name == name) return std::move(parameter);
    }
    return std::nullopt;
  }
  Result<void> set(const protocol::foxglove::Parameter& wish) override {
    const double* value = std::get_if<double>(&wish.value);
    if (wish.name != "a" || value == nullptr || *value <= 0.0) {
      return fail(ErrorCode::kInvalidArgument, wish.name + ": expected a number > 0");
    }
    a = *value;
    return {};
  }
  std::vector<std::string> complaints() override { return std::exchange(sentences, {}); }
  std::vector<telemetry::Change> applied() override { return std::exchange(changes, {}); }
  std::vector<protocol::foxglove::Parameter> news() override { return std::exchange(waiting, {}); }
  double a = 1.0;
  std::vector<std::string> sentences;
  std::vector<telemetry::Change> changes;
  std::vector<protocol::foxglove::Parameter> waiting;
};

}  // namespace chicane::wire
