// SPDX-License-Identifier: MIT
// Publishes a run as ROS 2 topics, with its parameters as services.
#include "chicane/ros/run_publisher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "chicane/protocol/car_messages.hpp"

namespace chicane::ros {
namespace {

constexpr double kDiagnosticsPeriod = 0.2;  // [s]
constexpr double kRunPeriod = 1.0;          // [s]
// Topics left out: sent by the car or its simulator, drawn by Foxglove alone, or long and only on request.
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

namespace {

using protocol::foxglove::Parameter;
using protocol::foxglove::ParameterStore;

/// Values of the named parameters; an unknown one has no value.
std::vector<Parameter> values_of(ParameterStore& store, const std::vector<std::string>& names) {
  std::vector<Parameter> values;
  for (const std::string& name : names) {
    auto known = store.get(name);
    values.push_back(known ? std::move(*known) : Parameter{.name = name, .value = {}});
  }
  return values;
}

std::string list(ParameterStore& store, std::string_view bytes) {
  const auto request = protocol::decode<protocol::NamesRequest>(bytes);
  if (!request) return {};
  protocol::ListReply reply{request->call};
  for (const Parameter& each : store.list()) {
    const bool is_asked =
        request->names.empty() ||
        std::any_of(request->names.begin(), request->names.end(), [&](const std::string& prefix) {
          return each.name == prefix || each.name.starts_with(prefix + ".");
        });
    if (is_asked) reply.names.push_back(each.name);
  }
  return encode(reply);
}

std::string get(ParameterStore& store, std::string_view bytes) {
  const auto request = protocol::decode<protocol::NamesRequest>(bytes);
  return request ? encode(protocol::GetReply{request->call, values_of(store, request->names)})
                 : std::string();
}

std::string describe(ParameterStore& store, std::string_view bytes) {
  const auto request = protocol::decode<protocol::NamesRequest>(bytes);
  return request ? encode(protocol::DescribeReply{request->call, values_of(store, request->names)})
                 : std::string();
}

std::string set(ParameterStore& store, std::string_view bytes) {
  const auto request = protocol::decode<protocol::SetRequest>(bytes);
  if (!request) return {};
  protocol::SetReply reply{request->call};
  for (const Parameter& each : request->parameters) {
    const Result<void> done = store.set(each);
    reply.outcomes.push_back({done.has_value(), done ? std::string() : done.error().message});
  }
  return encode(reply);
}

struct Offer {
  const char* name;
  const char* type;
  std::string (*answer)(ParameterStore&, std::string_view);
};
constexpr std::array<Offer, 4> kOffers{{{"list_parameters", "ListParameters", list},
                                        {"get_parameters", "GetParameters", get},
                                        {"describe_parameters", "DescribeParameters", describe},
                                        {"set_parameters", "SetParameters", set}}};

}  // namespace

Result<std::unique_ptr<ParameterServices>> ParameterServices::create(Participant& participant,
                                                                     ParameterStore& store, Run run) {
  std::unique_ptr<ParameterServices> services(new ParameterServices(store, std::move(run)));
  for (const Offer& offer : kOffers) {
    const std::string type = fmt::format("rcl_interfaces/srv/{}", offer.type);
    auto requests =
        participant.reader(fmt::format("rq/chicane/{}Request", offer.name), type + "_Request", {});
    if (!requests) return fail(requests.error());
    auto replies = participant.writer(fmt::format("rr/chicane/{}Reply", offer.name), type + "_Response", {});
    if (!replies) return fail(replies.error());
    services->services_.push_back(
        {.requests = std::move(*requests), .replies = std::move(*replies), .answer = offer.answer});
  }
  return services;
}

void ParameterServices::serve() {
  for (Service& service : services_) {
    for (Sample& sample : service.requests->take()) {
      run_([this, replies = service.replies, answer = service.answer, bytes = std::move(sample.bytes)] {
        if (const std::string reply = answer(store_, bytes); !reply.empty())
          static_cast<void>(replies->write(reply));
      });
    }
  }
}

}  // namespace chicane::ros
