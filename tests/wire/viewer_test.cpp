// SPDX-License-Identifier: MIT
#include "chicane/wire/viewer.hpp"

#include "wire/fake_viewer.hpp"

namespace chicane::wire {
namespace {

TEST_F(Viewer, IsGreetedWithWhatThereIs) {
  start({});
  const auto greeting = server.take();
  ASSERT_EQ(greeting.size(), 2U);  // no services, so none are advertised
  const json info = json::parse(*greeting[0].bytes);
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["capabilities"], json{"time"});
  EXPECT_EQ(json::parse(*greeting[1].bytes)["channels"].size(), protocol::ros_topics().size());
}

TEST_F(Viewer, IsToldOfTheLapsThatWereBeforeItCameAndOfOneThatNoFrameShows) {
  start({});
  telemetry::Frame frame;
  const auto publish = [&](std::uint64_t cycle, int lap) {
    frame.time += 1.0;
    frame.cycle = cycle;
    endpoint->publish(frame);
    if (lap > 0) endpoint->publish({.lap = lap}, frame.time);
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
  publish(1, 1);
  publish(2, 2);
  server.take();
  say(subscribe(5, "/chicane/lap"));
  EXPECT_EQ(laps(), (std::vector{1, 2}));
  publish(3, 0);
  server.take();
  endpoint->publish({.lap = 3}, frame.time);
  server.pass_time();
  EXPECT_EQ(laps(), std::vector{3});
  publish(0, 0);  // the run began anew
  publish(1, 1);
  join(2);
  say(subscribe(6, "/chicane/lap"), 2);
  EXPECT_EQ(laps(), std::vector{1});
}

TEST_F(Viewer, IsToldOfTheChangesThatTheRunHasTakenUpAndOfThoseBeforeItCame) {
  Store store;
  start({.parameters = &store});
  server.take();
  say(subscribe(5, "/chicane/change"));
  EXPECT_TRUE(server.take().empty());
  store.changes = {{.cycle = 3, .time = 0.12, .name = "latency_ms", .value = "80"}};
  const auto messages = news();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(subscription_of(messages[0]), 5U);
  EXPECT_EQ(messages[0].delivery, net::Delivery::kReliable);
  EXPECT_EQ(messages[0].bytes->substr(13), protocol::encode_change(0.12, 3, "latency_ms", "80"));
  store.changes = {{.cycle = 4, .time = 0.16, .name = "manual.steer", .value = "0.5"}};
  EXPECT_EQ(news().size(), 1U);
  join(2);
  say(subscribe(6, "/chicane/change"), 2);
  const auto before = server.take();
  ASSERT_EQ(before.size(), 1U) << "hands are not remembered";
  EXPECT_THAT(*before[0].bytes, HasSubstr("latency_ms"));
}

TEST_F(Viewer, KeepsTheChangesOfARunThatBeginsAnewAndNoneOfTheOneBefore) {
  Store store;
  start({.parameters = &store});
  // What a viewer that comes now is told of changes, by their values.
  const auto known_to = [&](net::ConnectionId id) {
    join(id);
    say(subscribe(6, "/chicane/change"), id);
    std::vector<std::string> known;
    for (const auto& message : server.take())
      for (const char* value : {"first", "second", "third"})
        if (message.bytes->find(value) != std::string::npos) known.emplace_back(value);
    return known;
  };
  telemetry::Frame frame = frame_at(40.0);
  frame.cycle = 1000;
  endpoint->publish(frame);
  server.pass_time();
  // The run before, its end, and the beginning of the next one within one look.
  store.changes = {{.cycle = 1001, .time = 40.04, .name = "track", .value = "first"},
                   {.cycle = 1, .time = 0.04, .name = "track", .value = "second"}};
  frame.time = 0.08;
  frame.cycle = 2;
  endpoint->publish(frame);
  server.pass_time();
  EXPECT_THAT(known_to(2), ElementsAre("second"));
  // Choices that begin a run are told before its first frame: with it, and looks before it.
  for (const bool has_frame : {true, false}) {
    frame.cycle = 500;
    endpoint->publish(frame);
    server.pass_time();
    store.changes = {{.name = "track", .value = "first", .starts_anew = true},
                     {.name = "car", .value = "third", .starts_anew = true}};
    frame = frame_at(0.0);
    if (has_frame) endpoint->publish(frame);
    server.pass_time();
    endpoint->publish(frame);
    server.pass_time();
    EXPECT_THAT(known_to(has_frame ? 3 : 4), ElementsAre("first", "third")) << has_frame;
  }
}

TEST_F(Viewer, LearnsThatARunIsOverAndThatItBeganAnew) {
  start({});
  say(subscribe(5, "/chicane/run"));
  telemetry::Frame frame = frame_at(3.0);
  frame.cycle = 75;
  endpoint->publish(frame);
  endpoint->set_end("failed", "the car left the road and did not come back");
  server.pass_time();
  const auto runs = [&] {
    std::vector<std::string> found;
    for (const auto& message : server.take()) {
      if (message.bytes->front() == 1) found.push_back(*message.bytes);
    }
    return found;
  };
  EXPECT_THAT(runs(), testing::Contains(HasSubstr("did not come back")));
  endpoint->publish(frame_at(0.0));
  server.pass_time();
  server.pass_time();
  const auto anew = runs();
  ASSERT_FALSE(anew.empty());
  EXPECT_THAT(anew.back(), testing::Not(HasSubstr("did not come back")));
}

TEST_F(Viewer, GetsTheNewestFrameOnlyAndOnlyOnce) {
  start({});
  say(subscribe(5, "/clock"));
  server.take();
  for (int i = 1; i <= 10; ++i) endpoint->publish(frame_at(i));
  const auto messages = news();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].bytes->front(), 2);  // the time of the run comes first
  EXPECT_EQ(subscription_of(messages[1]), 5U);
  const std::string_view payload = std::string_view(*messages[1].bytes).substr(13);
  EXPECT_EQ(payload.substr(4, 4), std::string_view("\x0a\0\0\0", 4));  // second 10
  EXPECT_EQ(messages[1].delivery, net::Delivery::kNewest);
  EXPECT_NE(messages[1].topic, messages[0].topic);
  EXPECT_TRUE(news().empty());
}

TEST_F(Viewer, IsServedAtTheAskedRate) {
  ViewerOptions options;
  options.rate_limit = 50.0;
  start(std::move(options));
  ASSERT_EQ(server.tasks.size(), 1U);
  EXPECT_EQ(server.tasks[0].first, std::chrono::milliseconds{20});
  server.pass_time();
  EXPECT_EQ(server.tasks.size(), 1U);  // goes on for ever
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
  messages = news();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_GT(messages[0].bytes->size(), empty_size);
}

TEST_F(Viewer, GetsNothingAfterItHasLeftOrUnsubscribed) {
  start({});
  connect(2, true);
  for (const net::ConnectionId id : {1U, 2U}) endpoint->on_message(id, subscribe(4, "/odom"), false);
  say(R"({"op":"unsubscribe","subscriptionIds":[4]})");
  endpoint->on_close(2, "gone");
  server.take();
  endpoint->publish(frame_at(1.0));
  EXPECT_TRUE(news().empty());
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
  messages = news();
  ASSERT_EQ(messages.size(), 1U);  // every viewer learns of it
  EXPECT_EQ(subscription_of(messages[0]), 8U);
  endpoint->on_message(1, service_call(1, ""), true);
  EXPECT_THAT(*server.take().at(0).bytes, HasSubstr("the run is over"));
  endpoint->on_message(1, service_call(0, "\2"), true);
  EXPECT_THAT(answer()["message"].get<std::string>(), HasSubstr("one boolean"));
  EXPECT_EQ(log, "pause step ");
}

TEST_F(Viewer, IsToldWhatFailedAfterItWasAcceptedWhoeverAsked) {
  Store store;
  start({.parameters = &store});
  connect(2, true);
  news();
  store.sentences = {"no run with a = 2"};
  const auto messages = news();
  ASSERT_EQ(messages.size(), 2U);
  for (const FakeServer::Sent& message : messages) {
    const json status = json::parse(*message.bytes);
    EXPECT_EQ(status["op"], "status");
    EXPECT_EQ(status["message"], "no run with a = 2");
  }
  EXPECT_TRUE(news().empty());
}

TEST_F(Viewer, SeesAnotherRunPausedAndBuildingAsTheOneBeforeWas) {
  start({});
  say(subscribe(1, "/chicane/run"));
  endpoint->set_paused(true);
  endpoint->change_run([](protocol::Run& run) { run.building = "track = oval"; });
  news();
  protocol::Run next;
  next.track = "hairpins";
  endpoint->set_run(next);
  const auto messages = news();
  ASSERT_EQ(messages.size(), 1U);
  next.is_paused = true;
  next.building = "track = oval";
  const protocol::RosTopic& topic = protocol::ros_topics()[channel_of("/chicane/run")];
  EXPECT_EQ(messages[0].bytes->substr(1 + 4 + 8), topic.encode({}, next));
}

TEST_F(Viewer, SetsParametersAndOthersSeeIt) {
  Store store;
  start({.parameters = &store});
  connect(2, true);
  say(R"({"op":"subscribeParameterUpdates","parameterNames":["a","no such"]})", 2);
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
  Store store;
  start({.parameters = &store});
  connect(2, true);
  say(R"({"op":"subscribeParameterUpdates","parameterNames":["b"]})");
  server.take();
  store.waiting = {{"a", 5.0}, {"b", 3.0}};
  server.pass_time();
  json told = answer();
  EXPECT_EQ(told["op"], "parameterValues");
  ASSERT_EQ(told["parameters"].size(), 1U);
  EXPECT_EQ(told["parameters"][0]["value"], 3.0);
  EXPECT_TRUE(news().empty());
  // What else follows from a change goes out with it, once.
  store.waiting = {{"a", 7.0}, {"b", 4.0}};
  say(R"({"op":"setParameters","parameters":[{"name":"a","value":7}]})");
  told = answer();
  ASSERT_EQ(told["parameters"].size(), 1U);
  EXPECT_EQ(told["parameters"][0]["name"], "b");
}

}  // namespace
}  // namespace chicane::wire
