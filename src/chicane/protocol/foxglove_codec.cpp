// SPDX-License-Identifier: MIT
// Foxglove protocol, server side: reads messages of clients, and writes those of the server.
#include "chicane/protocol/foxglove_codec.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "chicane/protocol/json.hpp"
#include "chicane/telemetry/mcap.hpp"

namespace chicane::protocol::foxglove {
namespace {

using telemetry::mcap::Fields;

// Opcodes of binary messages: three of the server, one of clients.
constexpr char kMessageData = 1;
constexpr char kTime = 2;
constexpr char kServiceResponse = 3;
constexpr char kServiceRequest = 2;

/// Value from a client for messages, cut to 40 bytes.
std::string shown(const Json& value) {
  std::string text = json_text(value, JsonLayout::kAscii);
  if (text.size() > 40) text = text.substr(0, 37) + "...";
  return text;
}

tl::unexpected<Error> refuse(std::string_view key, const Json& got, std::string_view expected) {
  return fail(ErrorCode::kParse, fmt::format("{}: got {}, expected {}", key, shown(got), expected));
}

/// Member of an object; null if it has none of that key.
const Json& member(const Json& object, const char* key) {
  static const Json missing;
  const auto found = object.find(key);
  return found == object.end() ? missing : *found;
}

Result<std::uint32_t> to_id(std::string_view key, const Json& value) {
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint32_t>::max();
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kLast) {
    return refuse(key, value, "a whole number from 0 to 4294967295");
  }
  return static_cast<std::uint32_t>(value.get<std::uint64_t>());
}

/// Applies `read` to each element of a list of bounded length.
template <class T, class Read>
Result<std::vector<T>> to_list(std::string_view key, const Json& value, Read read) {
  if (!value.is_array()) return refuse(key, value, "a list");
  if (value.size() > kMaxEntries) {
    return fail(ErrorCode::kParse,
                fmt::format("{}: got {} entries, expected at most {}", key, value.size(), kMaxEntries));
  }
  std::vector<T> list;
  for (const Json& element : value) {
    Result<T> entry = read(key, element);
    if (!entry) return fail(entry.error());
    list.push_back(std::move(*entry));
  }
  return list;
}

Result<std::string> to_text(std::string_view key, const Json& value) {
  if (!value.is_string()) return refuse(key, value, "a text");
  return value.get<std::string>();
}

Result<double> to_number(std::string_view key, const Json& value) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) return refuse(key, value, "a finite number");
  return value.get<double>();
}

Result<Subscription> to_subscription(std::string_view key, const Json& value) {
  if (!value.is_object()) return refuse(key, value, "objects with id and channelId");
  const auto id = to_id("subscriptions.id", member(value, "id"));
  if (!id) return fail(id.error());
  const auto channel = to_id("subscriptions.channelId", member(value, "channelId"));
  if (!channel) return fail(channel.error());
  return Subscription{*id, *channel};
}

Result<ParameterValue> to_value(std::string_view key, const Json& value) {
  if (value.is_null()) return ParameterValue{};
  if (value.is_boolean()) return ParameterValue{value.get<bool>()};
  if (value.is_string()) return ParameterValue{value.get<std::string>()};
  if (value.is_array()) {
    auto numbers = to_list<double>(key, value, to_number);
    if (!numbers) return fail(numbers.error());
    return ParameterValue{std::move(*numbers)};
  }
  const auto number = to_number(key, value);
  if (!number) return refuse(key, value, "a finite number, a text, true, false or a list of numbers");
  return ParameterValue{*number};
}

Result<Parameter> to_parameter(std::string_view key, const Json& value) {
  if (!value.is_object()) return refuse(key, value, "objects with name and value");
  auto name = to_text("parameters.name", member(value, "name"));
  if (!name) return fail(name.error());
  auto content = to_value(*name, member(value, "value"));
  if (!content) return fail(content.error());
  return Parameter{std::move(*name), std::move(*content)};
}

/// Id of a request, which its answer repeats.
std::optional<std::string> request_of(const Json& message) {
  const Json& id = member(message, "id");
  return id.is_string() ? std::optional{id.get<std::string>()} : std::nullopt;
}

/// Message of a list that was read and of further fields; the list's fault if it could not be read.
template <class Message, class T, class... Fields>
Result<ClientMessage> message_of(Result<std::vector<T>> list, Fields... fields) {
  if (!list) return fail(list.error());
  return Message{std::move(*list), std::move(fields)...};
}

Result<ClientMessage> to_received(const Json& message) {
  const Json& bytes = member(message, "bytes");
  if (!bytes.is_number_unsigned()) return refuse("bytes", bytes, "a whole number of 0 or more");
  const auto at = to_number("at", member(message, "at"));
  if (!at) return fail(at.error());
  return Received{bytes.get<std::uint64_t>(), *at};
}

Result<ClientMessage> parse_text(std::string_view bytes) {
  const Json message = parse_json(bytes);
  if (!message.is_object()) return fail(ErrorCode::kParse, "a text message must be one JSON object in UTF-8");
  const Json& op = member(message, "op");
  const auto names = [&] {
    return to_list<std::string>("parameterNames", member(message, "parameterNames"), to_text);
  };
  if (op == "subscribe")
    return message_of<Subscribe>(
        to_list<Subscription>("subscriptions", member(message, "subscriptions"), to_subscription));
  if (op == "unsubscribe")
    return message_of<Unsubscribe>(
        to_list<std::uint32_t>("subscriptionIds", member(message, "subscriptionIds"), to_id));
  if (op == "setParameters")
    return message_of<SetParameters>(
        to_list<Parameter>("parameters", member(message, "parameters"), to_parameter), request_of(message));
  if (op == "getParameters") return message_of<GetParameters>(names(), request_of(message));
  if (op == "subscribeParameterUpdates") return message_of<SubscribeParameters>(names());
  if (op == "unsubscribeParameterUpdates") return message_of<UnsubscribeParameters>(names());
  if (op == "received") return to_received(message);
  return fail(ErrorCode::kParse, fmt::format("op: {} is not offered by this server", shown(op)));
}

Result<ClientMessage> parse_binary(std::string_view bytes) {
  if (bytes.empty() || bytes[0] != kServiceRequest) {
    return fail(ErrorCode::kParse, "a binary message must be a service call (opcode 2)");
  }
  telemetry::mcap::FieldReader fields(bytes.substr(1));
  CallService call;
  call.service = fields.number<std::uint32_t>();
  call.call = fields.number<std::uint32_t>();
  call.encoding = fields.text();
  call.payload = fields.rest();
  if (fields.is_short())
    return fail(ErrorCode::kParse, fmt::format("service call: {} bytes are too few", bytes.size()));
  return call;
}

Json to_json(const Parameter& parameter) {
  Json json{{"name", parameter.name}};
  if (const auto* flag = std::get_if<bool>(&parameter.value)) json["value"] = *flag;
  if (const auto* text = std::get_if<std::string>(&parameter.value)) json["value"] = *text;
  // JSON has one kind of number: the type shows viewers that 3 may become 3.5.
  if (const auto* number = std::get_if<double>(&parameter.value)) {
    json["value"] = *number;
    json["type"] = "float64";
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&parameter.value)) {
    json["value"] = *numbers;
    json["type"] = "float64_array";
  }
  return json;
}

}  // namespace

Result<ClientMessage> parse(std::string_view bytes, bool binary) {
  return binary ? parse_binary(bytes) : parse_text(bytes);
}

std::string server_info(std::string_view name, std::string_view session, Capabilities can) {
  Json capabilities = {"time"};
  if (can.parameters) capabilities.insert(capabilities.end(), {"parameters", "parametersSubscribe"});
  if (can.services) capabilities.push_back("services");
  return json_text({{"op", "serverInfo"},
                    {"name", name},
                    {"capabilities", capabilities},
                    {"supportedEncodings", {"cdr"}},
                    {"metadata", {{"ROS_DISTRO", "jazzy"}}},
                    {"sessionId", session}});
}

std::string advertise(std::span<const Channel> channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel.type},
                    {"schema", channel.schema},
                    {"schemaEncoding", "ros2msg"}});
  }
  return json_text({{"op", "advertise"}, {"channels", list}});
}

std::string advertise_services(std::span<const Service> services) {
  Json list = Json::array();
  for (const Service& service : services) {
    const auto side = [&](std::string_view suffix, std::string_view schema) {
      return Json{{"encoding", "cdr"},
                  {"schemaName", fmt::format("{}{}", service.type, suffix)},
                  {"schemaEncoding", "ros2msg"},
                  {"schema", schema}};
    };
    list.push_back({{"id", service.id},
                    {"name", service.name},
                    {"type", service.type},
                    {"requestSchema", service.request_schema},  // field for older viewers
                    {"responseSchema", service.response_schema},
                    {"request", side("_Request", service.request_schema)},
                    {"response", side("_Response", service.response_schema)}});
  }
  return json_text({{"op", "advertiseServices"}, {"services", list}});
}

std::string status(StatusLevel level, std::string_view message) {
  return json_text({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::string heard(double at, double held) { return json_text({{"op", "heard"}, {"at", at}, {"held", held}}); }

std::string past_left(std::size_t messages) {
  return json_text({{"op", "pastLeft"}, {"messages", messages}});
}

std::string parameter_values(std::span<const Parameter> parameters,
                             const std::optional<std::string>& request) {
  Json list = Json::array();
  for (const Parameter& parameter : parameters) list.push_back(to_json(parameter));
  Json json{{"op", "parameterValues"}, {"parameters", list}};
  if (request) json["id"] = *request;
  return json_text(json);
}

std::string service_failure(const CallService& call, std::string_view message) {
  return json_text({{"op", "serviceCallFailure"},
                    {"serviceId", call.service},
                    {"callId", call.call},
                    {"message", message}});
}

std::string message_data(std::uint32_t subscription, std::uint64_t time, std::string_view payload) {
  std::string bytes;
  bytes.reserve(13 + payload.size());
  bytes.push_back(kMessageData);
  Fields(bytes).number(subscription).number(time);
  return bytes.append(payload);
}

std::string time_message(std::uint64_t time) {
  std::string bytes(1, kTime);
  Fields(bytes).number(time);
  return bytes;
}

std::string service_response(const CallService& call, std::string_view payload) {
  std::string bytes(1, kServiceResponse);
  Fields(bytes).number(call.service).number(call.call).text(call.encoding);
  return bytes.append(payload);
}

}  // namespace chicane::protocol::foxglove
