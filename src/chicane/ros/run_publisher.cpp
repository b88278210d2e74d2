// SPDX-License-Identifier: MIT
// Publishes a run as ROS 2 topics, with its parameters as services.
#include "chicane/ros/run_publisher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "chicane/protocol/car_messages.hpp"

namespace chicane::ros {
namespace {

constexpr double kDiagnosticsPeriod = 0.2;  // [s] least time between diagnostics; chosen
constexpr double kRunPeriod = 1.0;          // [s] least time between descriptions of the run; chosen
// Topics left out: those that the car or its simulator sends, that Foxglove alone draws, or that are long.
constexpr std::array<std::string_view, 7> kNotOurs{
    "/tf", "/drive", "/clock", "/scene", "/chicane/change", "/chicane/limit", "/track/racing_line"};

bool is_ours(std::string_view name) {
  return std::find(kNotOurs.begin(), kNotOurs.end(), name) == kNotOurs.end();
}

/// Least time between two messages of a topic [s].
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

/// Parameters of these names; an unknown one has no value.
std::vector<Parameter> values_of(ParameterStore& store, const std::vector<std::string>& names) {
  std::vector<Parameter> values;
  for (const std::string& name : names) {
    auto known = store.get(name);
    values.push_back(known ? std::move(*known) : Parameter{.name = name, .value = {}});
  }
  return values;
}

// Functions that reply to a request, one for each service.

/// Names of the parameters that begin with one of the requested prefixes.
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

/// The requested parameters, as a reply of one type.
template <class Reply>
std::string named(ParameterStore& store, std::string_view bytes) {
  const auto request = protocol::decode<protocol::NamesRequest>(bytes);
  return request ? encode(Reply{request->call, values_of(store, request->names)}) : std::string();
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

std::string types(ParameterStore& store, std::string_view bytes) {
  const auto request = protocol::decode<protocol::NamesRequest>(bytes);
  if (!request) return {};
  protocol::CdrWriter reply;
  reply.put(request->call.client, request->call.sequence).count(request->names.size());
  for (const Parameter& each : values_of(store, request->names)) reply.put(protocol::type_number(each));
  return reply.bytes();
}

/// Refusal: the store can only set one parameter after the other.
std::string set_atomically(ParameterStore&, std::string_view bytes) {
  const auto request = protocol::decode<protocol::SetRequest>(bytes);
  if (!request) return {};
  protocol::CdrWriter reply;
  reply.put(request->call.client, request->call.sequence, std::uint8_t{0});
  return reply.text("got set_parameters_atomically, expected set_parameters").bytes();
}

/// Service of ROS 2 nodes: name, type, and the function that replies.
struct Offer {
  const char* name;
  const char* type;
  std::string (*answer)(ParameterStore&, std::string_view);
};
// All six services, because clients of rclpy, such as `ros2 param`, wait for all of them.
constexpr std::array<Offer, 6> kOffers{
    {{"list_parameters", "ListParameters", list},
     {"get_parameters", "GetParameters", named<protocol::GetReply>},
     {"get_parameter_types", "GetParameterTypes", types},
     {"describe_parameters", "DescribeParameters", named<protocol::DescribeReply>},
     {"set_parameters", "SetParameters", set},
     {"set_parameters_atomically", "SetParametersAtomically", set_atomically}}};

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
  // The call of a request is in the message behind the header (rmw_cyclonedds), or beside it (rmw_fastrtps).
  constexpr std::size_t kHeader = 4, kCall = sizeof(protocol::ServiceCall);
  for (Service& service : services_) {
    for (Sample& sample : service.requests->take()) {
      if (!sample.call.empty()) sample.bytes.insert(kHeader, kCall, '\0');
      run_([this, replies = service.replies, answer = service.answer, sample = std::move(sample)] {
        std::string reply = answer(store_, sample.bytes);
        if (reply.empty()) return;
        if (!sample.call.empty()) reply.erase(kHeader, kCall);
        static_cast<void>(replies->reply(reply, sample.call));
      });
    }
  }
}

}  // namespace chicane::ros
