// SPDX-License-Identifier: MIT
#include "chicane/wire/viewer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

namespace chicane::wire {
namespace {

using nlohmann::json;
using testing::HasSubstr;

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
  void close(net::ConnectionId, std::uint16_t, std::string_view) override {}
  void run_after(std::chrono::nanoseconds delay, std::function<void()> task) override {
    waiting.emplace_back(delay, std::move(task));
  }
  /// Everything that was waiting happens, once.
  void pass_time() {
    for (auto& [delay, task] : std::exchange(waiting, {})) task();
  }
  std::vector<Sent> take() { return std::exchange(sent, {}); }

  std::vector<Sent> sent;
  std::vector<std::pair<std::chrono::nanoseconds, std::function<void()>>> waiting;
};

telemetry::Frame frame_at(double time) {
  telemetry::Frame frame;
  frame.time = time;
  return frame;
}

std::uint32_t channel_of(std::string_view topic) {
  const auto& topics = protocol::ros_topics();
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].name == topic) return static_cast<std::uint32_t>(i);
  }
  ADD_FAILURE() << topic;
  return 0;
}

std::string subscribe(std::uint32_t id, std::string_view topic) {
  return json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel_of(topic)}}}}}
      .dump();
}

std::uint32_t subscription_of(const FakeServer::Sent& message) {
  std::uint32_t id = 0;
  std::memcpy(&id, message.bytes->data() + 1, sizeof(id));
  return id;
}

std::string service_call(std::uint32_t service, std::string_view payload) {
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
    endpoint->on_open(1);
  }
  void say(const std::string& text) { endpoint->on_message(1, text, false); }
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

TEST_F(Viewer, IsGreetedWithWhatThereIs) {
  start({});
  const auto greeting = server.take();
  ASSERT_EQ(greeting.size(), 2U);  // no services, so none are advertised
  const json info = json::parse(*greeting[0].bytes);
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["capabilities"], json{"time"});
  EXPECT_EQ(json::parse(*greeting[1].bytes)["channels"].size(), protocol::ros_topics().size());
}

TEST_F(Viewer, IsToldOfTheLapsThatWereBeforeItCame) {
  start({});
  server.take();
  telemetry::Frame frame = frame_at(1.0);
  const auto publish = [&](int lap) {
    frame.time += 1.0;
    frame.cycle = lap > 0 ? frame.cycle + 1 : 0;
    if (lap > frame.completed_lap.lap) endpoint->publish({.lap = lap}, frame.time);
    frame.completed_lap.lap = lap;
    endpoint->publish(frame);
    server.pass_time();
  };
  const auto laps = [&] {
    std::vector<int> numbers;
    for (const auto& message : server.take()) {
      EXPECT_EQ(message.delivery, net::Delivery::kReliable);
      numbers.push_back(message.bytes->at(13 + 4));  // after Foxglove's header and CDR's
    }
    return numbers;
  };
  for (const int lap : {0, 1, 1, 2}) publish(lap);
  server.take();
  say(subscribe(5, "/chicane/lap"));
  EXPECT_EQ(laps(), (std::vector{1, 2}));
  publish(2);
  server.take();
  publish(3);
  const auto messages = server.take();
  EXPECT_EQ(std::count_if(messages.begin(), messages.end(),
                          [](const auto& message) { return message.bytes->front() == 1; }),
            1);
  publish(0);  // the run began anew
  publish(1);
  server.take();
  endpoint->on_open(2);
  server.take();
  endpoint->on_message(2, subscribe(6, "/chicane/lap"), false);
  EXPECT_EQ(laps(), (std::vector{1}));
}

TEST_F(Viewer, IsToldOfALapThatNoFrameShows) {
  start({});
  say(subscribe(5, "/chicane/lap"));
  endpoint->publish(frame_at(1.0));
  server.pass_time();
  server.take();
  endpoint->publish({.lap = 3}, 1.02);  // the run ends here
  server.pass_time();
  const auto messages = server.take();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].bytes->at(13 + 4), 3);
}

TEST_F(Viewer, GetsTheNewestFrameOnlyAndOnlyOnce) {
  start({});
  say(subscribe(5, "/clock"));
  server.take();
  for (int i = 1; i <= 10; ++i) endpoint->publish(frame_at(i));
  server.pass_time();
  const auto messages = server.take();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].bytes->front(), 2);  // the time of the run comes first
  EXPECT_EQ(subscription_of(messages[1]), 5U);
  const std::string_view payload = std::string_view(*messages[1].bytes).substr(13);
  EXPECT_EQ(payload.substr(4, 4), std::string_view("\x0a\0\0\0", 4));  // second 10
  EXPECT_EQ(messages[1].delivery, net::Delivery::kNewest);
  EXPECT_NE(messages[1].topic, messages[0].topic);
  server.pass_time();
  EXPECT_TRUE(server.take().empty());
}

TEST_F(Viewer, IsServedAtTheAskedRate) {
  ViewerOptions options;
  options.rate_limit = 50.0;
  start(std::move(options));
  ASSERT_EQ(server.waiting.size(), 1U);
  EXPECT_EQ(server.waiting[0].first, std::chrono::milliseconds{20});
  server.pass_time();
  EXPECT_EQ(server.waiting.size(), 1U);  // goes on for ever
}

TEST_F(Viewer, LearnsTheRoadWhenItSubscribesAndWhenItChanges) {
  start({});
  server.take();
  say(subscribe(3, "/track/left"));
  auto messages = server.take();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].delivery, net::Delivery::kReliable);
  const std::size_t empty_size = messages[0].bytes->size();
  protocol::Run run;
  run.road.left = {{0.0, 0.0}, {1.0, 0.0}};
  endpoint->set_run(run);
  server.pass_time();
  messages = server.take();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_GT(messages[0].bytes->size(), empty_size);
}

TEST_F(Viewer, LearnsTheLastFrameWhenItComesLate) {
  start({});
  endpoint->publish(frame_at(3.0));
  server.pass_time();
  server.take();
  say(subscribe(1, "/odom"));
  EXPECT_EQ(server.take().size(), 1U);
}

TEST_F(Viewer, SharesBytesWithViewersOfTheSameKind) {
  start({});
  endpoint->on_open(2);
  for (const net::ConnectionId id : {1U, 2U}) endpoint->on_message(id, subscribe(4, "/odom"), false);
  server.take();
  endpoint->publish(frame_at(1.0));
  server.pass_time();
  const auto messages = server.take();
  ASSERT_EQ(messages.size(), 4U);
  EXPECT_EQ(messages[2].bytes, messages[3].bytes);
  EXPECT_NE(messages[2].to, messages[3].to);
}

TEST_F(Viewer, GetsNothingAfterItHasLeftOrUnsubscribed) {
  start({});
  endpoint->on_open(2);
  for (const net::ConnectionId id : {1U, 2U}) endpoint->on_message(id, subscribe(4, "/odom"), false);
  say(R"({"op":"unsubscribe","subscriptionIds":[4]})");
  endpoint->on_close(2, "gone");
  server.take();
  endpoint->publish(frame_at(1.0));
  server.pass_time();
  EXPECT_TRUE(server.take().empty());
}

TEST_F(Viewer, IsToldInWordsWhatItDidWrong) {
  start({});
  server.take();
  say(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":77}]})");
  EXPECT_EQ(answer()["message"], "subscribe: there is no channel 77");
  say(subscribe(1, "/odom"));
  say(subscribe(2, "/odom"));
  EXPECT_EQ(answer()["message"], "subscribe: /odom is subscribed to already");
  say(R"({"op":"unsubscribe","subscriptionIds":[9]})");
  EXPECT_EQ(answer()["message"], "unsubscribe: there is no subscription 9");
  say(R"({"op":"setParameters","parameters":[]})");
  EXPECT_EQ(answer()["message"], "setParameters: this run has none");
  say("nonsense");
  EXPECT_THAT(answer()["message"].get<std::string>(), HasSubstr("JSON"));
  endpoint->on_message(1, service_call(3, ""), true);
  EXPECT_EQ(answer()["message"], "there is no service 3");
}

TEST_F(Viewer, PausesStepsAndResetsTheRun) {
  std::string log;
  ViewerOptions options;
  options.services.pause = [&](bool paused) -> Result<void> {
    log += paused ? "pause " : "resume ";
    return {};
  };
  options.services.step = [&]() -> Result<void> {
    log += "step ";
    return fail(ErrorCode::kInvalidArgument, "the run is over");
  };
  start(std::move(options));
  EXPECT_EQ(json::parse(*server.take().at(2).bytes)["services"].size(), 2U);  // no reset was given
  say(subscribe(8, "/chicane/run"));
  server.take();
  endpoint->on_message(1, service_call(0, "\1"), true);
  auto messages = server.take();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_THAT(*messages[0].bytes, HasSubstr("paused"));
  server.pass_time();
  messages = server.take();
  ASSERT_EQ(messages.size(), 1U);  // every viewer learns of it
  EXPECT_EQ(subscription_of(messages[0]), 8U);
  endpoint->on_message(1, service_call(1, ""), true);
  EXPECT_THAT(*server.take().at(0).bytes, HasSubstr("the run is over"));
  endpoint->on_message(1, service_call(0, "\2"), true);
  EXPECT_THAT(answer()["message"].get<std::string>(), HasSubstr("one boolean"));
  EXPECT_EQ(log, "pause step ");
}

TEST_F(Viewer, MustSpeakOneOfTheTwoSubprotocols) {
  start({});
  const auto answer_to = [&](std::vector<std::string> offered) {
    net::UpgradeRequest request;
    request.subprotocols = std::move(offered);
    return endpoint->on_upgrade(request);
  };
  EXPECT_EQ(answer_to({"foxglove.websocket.v1"}).subprotocol, "foxglove.websocket.v1");
  EXPECT_EQ(answer_to({"foxglove.websocket.v1", "foxglove.sdk.v1"}).subprotocol, "foxglove.sdk.v1");
  EXPECT_FALSE(answer_to({"soap"}).accept);
}

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
  double a = 1.0;
  std::vector<std::string> sentences;
};

TEST_F(Viewer, IsToldWhatFailedAfterItWasAcceptedWhoeverAsked) {
  Store store;
  ViewerOptions options;
  options.parameters = &store;
  start(std::move(options));
  endpoint->on_open(2);
  server.pass_time();
  server.take();
  store.sentences = {"no run with a = 2"};
  server.pass_time();
  const auto messages = server.take();
  ASSERT_EQ(messages.size(), 2U);
  for (const FakeServer::Sent& message : messages) {
    const json status = json::parse(*message.bytes);
    EXPECT_EQ(status["op"], "status");
    EXPECT_EQ(status["message"], "no run with a = 2");
  }
  server.pass_time();
  EXPECT_TRUE(server.take().empty());
}

TEST_F(Viewer, SeesAnotherRunPausedAndBuildingAsTheOneBeforeWas) {
  start({});
  say(subscribe(1, "/chicane/run"));
  endpoint->set_paused(true);
  endpoint->change_run([](protocol::Run& run) { run.building = "track = oval"; });
  server.pass_time();
  server.take();
  protocol::Run next;
  next.track = "hairpins";
  endpoint->set_run(next);
  server.pass_time();
  const auto messages = server.take();
  ASSERT_EQ(messages.size(), 1U);
  next.is_paused = true;
  next.building = "track = oval";
  const protocol::RosTopic& topic = protocol::ros_topics()[channel_of("/chicane/run")];
  EXPECT_EQ(messages[0].bytes->substr(1 + 4 + 8), topic.encode({}, next));
}

TEST_F(Viewer, SetsParametersAndOthersSeeIt) {
  Store store;
  ViewerOptions options;
  options.parameters = &store;
  start(std::move(options));
  endpoint->on_open(2);
  endpoint->on_message(2, R"({"op":"subscribeParameterUpdates","parameterNames":["a","no such"]})", false);
  server.take();
  say(R"({"op":"setParameters","parameters":[{"name":"a","value":7}],"id":"x"})");
  auto messages = server.take();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(json::parse(*messages[0].bytes)["id"], "x");
  EXPECT_EQ(messages[1].to, 2U);
  EXPECT_EQ(json::parse(*messages[1].bytes)["parameters"][0]["value"], 7.0);
  say(R"({"op":"setParameters","parameters":[{"name":"a","value":-1}],"id":"y"})");
  messages = server.take();
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(json::parse(*messages[0].bytes)["message"], "a: expected a number > 0");
  EXPECT_EQ(json::parse(*messages[1].bytes)["parameters"][0]["value"], 7.0);  // the slider springs back
  say(R"({"op":"getParameters","parameterNames":[]})");
  EXPECT_EQ(answer()["parameters"].size(), 2U);
  EXPECT_EQ(store.a, 7.0);
}

TEST_F(Viewer, TellsOfParametersThatChangeWithoutBeingSet) {
  struct Lively final : Store {
    std::vector<protocol::foxglove::Parameter> news() override { return std::exchange(waiting, {}); }
    std::vector<protocol::foxglove::Parameter> waiting;
  } store;
  ViewerOptions options;
  options.parameters = &store;
  start(std::move(options));
  endpoint->on_open(2);
  say(R"({"op":"subscribeParameterUpdates","parameterNames":["b"]})");
  server.take();
  store.waiting = {{"a", 5.0}, {"b", 3.0}};
  server.pass_time();
  json told = answer();
  EXPECT_EQ(told["op"], "parameterValues");
  ASSERT_EQ(told["parameters"].size(), 1U);
  EXPECT_EQ(told["parameters"][0]["value"], 3.0);
  server.pass_time();
  EXPECT_TRUE(server.take().empty());
  // What else follows from a wish goes out with it, once.
  store.waiting = {{"a", 7.0}, {"b", 4.0}};
  say(R"({"op":"setParameters","parameters":[{"name":"a","value":7}]})");
  told = answer();
  ASSERT_EQ(told["parameters"].size(), 1U);
  EXPECT_EQ(told["parameters"][0]["name"], "b");
}

TEST_F(Viewer, PublishesTheChangesThatTheRunHasTakenUp) {
  struct Lively final : Store {
    std::vector<telemetry::Change> applied() override { return std::exchange(waiting, {}); }
    std::vector<telemetry::Change> waiting;
  } store;
  ViewerOptions options;
  options.parameters = &store;
  start(std::move(options));
  say(subscribe(9, "/chicane/change"));
  EXPECT_EQ(server.take().size(), 2U);  // the greeting; no change yet
  store.waiting = {{.cycle = 7, .time = 0.28, .name = "latency_ms", .value = "30"},
                   {.cycle = 7, .time = 0.28, .name = "run.pace", .value = "2"}};
  server.pass_time();
  const auto messages = server.take();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(subscription_of(messages[0]), 9U);
  EXPECT_EQ(messages[0].delivery, net::Delivery::kReliable);
  EXPECT_EQ(messages[0].bytes->substr(13), protocol::encode_change(0.28, 7, "latency_ms", "30"));
}

}  // namespace
}  // namespace chicane::wire
