// SPDX-License-Identifier: MIT
// What a viewer that comes late gets, in which order, and how much at a time.
#include <atomic>
#include <thread>

#include "wire/fake_viewer.hpp"

namespace chicane::wire {
namespace {

std::string subscribe_past(std::uint32_t id) { return subscribe(id, protocol::ros_topics().size()); }

/// A run of 300 frames.
class ViewerOfAPast : public Viewer {
 protected:
  void drive(int frames) {
    for (int i = 0; i < frames; ++i) {
      frame.time += 0.04;
      ++frame.cycle;
      endpoint->publish(frame);
      clock += 0.04;
      server.pass_time();
    }
  }
  void begin() {
    start({.clock = [this] { return clock; }});
    drive(300);
    server.take();
  }
  telemetry::Frame frame;
  double clock = 100.0;
};

TEST_F(ViewerOfAPast, GetsThePresentAtOnceAndTheFramesOfBeforeBehindIt) {
  begin();
  connect(2, false, "/viewer?x=1&past");
  connect(3, false, "/viewer?passed");
  server.take();
  say(subscribe_past(5), 3);
  EXPECT_THAT(answer()["message"].get<std::string>(), HasSubstr("no channel")) << "it has not asked";
  say(subscribe(4, "/chicane/frame"), 2);
  EXPECT_EQ(times_of(server.take(), 2, 4).size(), 1U);
  say(subscribe_past(5), 2);
  std::vector<int> left;  // what it is told of
  const auto after_a_frame = [&] {
    drive(1);
    const auto messages = server.take();
    for (const auto& message : messages)
      if (message.to == 2 && !message.binary) left.push_back(json::parse(*message.bytes)["messages"]);
    return messages;
  };
  const auto first = after_a_frame();
  EXPECT_EQ(subscription_of(first.at(1)), 4U) << "the time, then the newest frame";
  std::vector<double> seen = times_of(first, 2, 5);
  EXPECT_EQ(seen.size(), 192U) << "a page, and the next one when it has been read";
  for (const double time : times_of(after_a_frame(), 2, 5)) seen.push_back(time);
  ASSERT_EQ(seen.size(), 300U) << "those that were before it subscribed";
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_NEAR(seen[i], 0.04 * (300.0 - static_cast<double>(i)), 1e-6);
  EXPECT_TRUE(times_of(after_a_frame(), 2, 5).empty());
  EXPECT_EQ(left, (std::vector{108, 0}));
}

TEST_F(ViewerOfAPast, HasTheLastLapBeforeItIsSentAway) {
  begin();
  connect(2, false, "/viewer?paced");
  endpoint->on_close(1, "");
  say(subscribe(4, "/chicane/frame"), 2);
  say(subscribe(5, "/chicane/lap"), 2);
  std::size_t sent = 0;
  int laps = 0;
  const auto look = [&] {
    for (const auto& message : server.take()) {
      if (!message.binary) continue;
      sent += message.bytes->size();
      if (message.bytes->front() == 1 && subscription_of(message) == 5) ++laps;
    }
  };
  drive(100);  // of which it reads nothing
  look();
  std::size_t read = 0;
  endpoint->publish(telemetry::CompletedLap{.lap = 1}, frame.time);
  std::atomic<bool> is_over{false};
  std::thread end([&] {
    endpoint->dismiss();
    is_over = true;
  });
  for (int i = 0; i < 10'000 && server.closed.empty(); ++i) {
    read = std::min(sent, read + 100);
    say(json{{"op", "received"}, {"bytes", read}, {"at", clock}}.dump(), 2);
    std::this_thread::sleep_for(std::chrono::microseconds{100});
    server.pass_time();
    look();
  }
  EXPECT_EQ(server.closed, std::vector<net::ConnectionId>{2});
  EXPECT_EQ(laps, 1) << "the newest frame may go beyond the window, laps may not";
  endpoint->on_close(2, "");
  while (!is_over) {
    server.pass_time();
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  end.join();
}

/// How long the end of a run waits for a viewer that has not read its past.
class ViewerAtTheEnd : public ViewerOfAPast {
 protected:
  using Clock = std::chrono::steady_clock;
  using Milliseconds = std::chrono::milliseconds;
  Clock::duration wait(bool reads, const ViewerEndpoint::Patience& patience) {
    begin();
    connect(2, false, "/viewer?past&paced");
    say(subscribe_past(5), 2);
    drive(20);
    const auto begin = Clock::now();
    std::atomic<bool> is_over{false};
    std::thread end([&] {
      endpoint->dismiss(patience);
      is_over = true;
    });
    for (std::size_t read = 0; !is_over; read += reads ? 1 : 0) {
      say(json{{"op", "received"}, {"bytes", read}, {"at", clock}}.dump(), 2);
      server.pass_time();
      std::this_thread::sleep_for(Milliseconds{2});
    }
    end.join();
    return Clock::now() - begin;
  }
};

TEST_F(ViewerAtTheEnd, IsWaitedForWhileItReads) {
  EXPECT_GE(wait(true, {Milliseconds{200}, Milliseconds{600}}), Milliseconds{600});
}

TEST_F(ViewerAtTheEnd, IsNotWaitedForWhenItReadsNothing) {
  EXPECT_LT(wait(false, {Milliseconds{50}, Milliseconds{20'000}}), Milliseconds{10'000});
}

TEST_F(Viewer, GetsAllLapsBeforeTheFramesOfBefore) {
  start({});
  telemetry::Frame frame;
  for (int lap = 1; lap <= 40; ++lap) {
    frame.time += 20.0;
    ++frame.cycle;
    endpoint->publish({.lap = lap}, frame.time);
    endpoint->publish(frame);
    server.pass_time();
  }
  join(2, "/viewer?past");
  say(subscribe_past(4), 2);
  say(subscribe(5, "/chicane/lap"), 2);
  std::string order;
  for (int i = 0; i < 4; ++i) {
    for (const auto& message : server.take()) {
      if (message.to == 2 && message.binary && message.bytes->front() == 1)
        order += subscription_of(message) == 5 ? 'l' : 'f';
    }
    server.pass_time();
  }
  EXPECT_EQ(std::count(order.begin(), order.end(), 'l'), 40);
  EXPECT_GT(order.find('f'), order.rfind('l')) << order;
}

}  // namespace
}  // namespace chicane::wire
