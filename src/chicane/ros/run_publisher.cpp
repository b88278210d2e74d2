// SPDX-License-Identifier: MIT
#include "chicane/ros/run_publisher.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace chicane::ros {
namespace {

constexpr double kDiagnosticsPeriod = 0.2;  // [s]
constexpr double kRunPeriod = 1.0;          // [s]
// Sent by the car or its simulator, drawn by Foxglove alone, or long and asked for by viewers.
constexpr std::array<std::string_view, 7> kNotOurs{
    "/tf", "/drive", "/clock", "/scene", "/chicane/change", "/chicane/limit", "/track/racing_line"};

bool is_ours(std::string_view name) {
  for (const std::string_view each : kNotOurs)
    if (each == name) return false;
  return true;
}

double period_of(const protocol::RosTopic& topic) {
  if (topic.name == "/diagnostics") return kDiagnosticsPeriod;
  return topic.cadence == protocol::Cadence::kRun ? kRunPeriod : 0.0;
}

}  // namespace

Result<std::unique_ptr<RunPublisher>> RunPublisher::create(Participant& participant,
                                                           const protocol::Run& run) {
  std::unique_ptr<RunPublisher> publisher(new RunPublisher(run));
  for (const protocol::RosTopic& topic : protocol::ros_topics()) {
    if (!is_ours(topic.name) || topic.encode == nullptr) continue;
    const bool is_road = topic.cadence == protocol::Cadence::kRoad;
    const std::string name = topic.name == "/odom" ? "/chicane/odom" : std::string(topic.name);
    auto writer = participant.writer(name, std::string(topic.type),
                                     {.is_transient_local = is_road, .depth = is_road ? 1 : 10});
    if (!writer) return fail(writer.error());
    if (is_road) static_cast<void>((*writer)->write(topic.encode({}, run)));
    publisher->topics_.push_back({.topic = &topic, .writer = std::move(*writer), .period = period_of(topic)});
  }
  return publisher;
}

void RunPublisher::publish(const telemetry::Frame& frame, double offset) {
  shifted_ = frame;
  shifted_.time += offset;
  controller::Plan& plan = shifted_.result.plan;
  for (int i = 0; i < plan.size; ++i) plan.points[static_cast<std::size_t>(i)].time += offset;
  for (Topic& each : topics_) {
    using enum protocol::Cadence;
    const bool is_due = each.topic->cadence == kFrame || each.topic->cadence == kRun;
    if (!is_due || frame.time - each.last < each.period || each.writer->matched() == 0) continue;
    each.last = frame.time;
    static_cast<void>(each.writer->write(each.topic->encode(shifted_, run_)));
  }
}

void RunPublisher::publish(const telemetry::CompletedLap& lap) {
  telemetry::Frame frame;
  frame.completed_lap = lap;
  for (Topic& each : topics_) {
    if (each.topic->cadence == protocol::Cadence::kLap)
      static_cast<void>(each.writer->write(each.topic->encode(frame, run_)));
  }
}

}  // namespace chicane::ros
