// SPDX-License-Identifier: MIT
// Requests of viewers to a ViewerEndpoint: subscriptions, parameters and services.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "chicane/wire/detail/viewer_channels.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::wire {

namespace foxglove = protocol::foxglove;
using detail::data_of;
using detail::delivery_of;
using detail::past_channel;
using protocol::Cadence;

namespace {

constexpr std::string_view kWatchOnly =
    "this connection may watch only; connect with the token of the link that the program printed to control";

}  // namespace

void ViewerEndpoint::on_message(net::ConnectionId id, std::string_view bytes, bool binary) {
  const Result<foxglove::ClientMessage> message = foxglove::parse(bytes, binary);
  if (!message) return warn(id, message.error().message);
  std::visit([&](const auto& content) { handle(id, content); }, *message);
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::Subscribe& message) {
  const auto& topics = protocol::ros_topics();
  for (const auto& [subscription, channel] : message.subscriptions) {
    Client& client = clients_[id];
    const bool is_past = client.wants_past && channel == past_channel();
    if (channel >= topics.size() && !is_past) {
      warn(id, fmt::format("subscribe: there is no channel {}", channel));
      continue;
    }
    if (!client.subscriptions.try_emplace(channel, subscription).second) {
      warn(id, fmt::format("subscribe: {} is subscribed to already",
                           is_past ? detail::kPastTopic : topics[channel].name));
      continue;
    }
    // Send the current content, because the next change may be far away. Frames of a paced viewer, and past
    // frames, follow from the next tick on, after the description of the run.
    if (is_past) {
      client.past_before = memory_.end();
      continue;
    }
    const Cadence cadence = topics[channel].cadence;
    if (client.pace && cadence == Cadence::kFrame) {
      client.is_behind = has_frame_;
      continue;
    }
    if (client.pace && (cadence == Cadence::kRoad || cadence == Cadence::kLimit)) {
      client.owed.insert(channel);
      continue;
    }
    if (cadence == Cadence::kLap) client.next_lap = 0;
    if (cadence == Cadence::kEvent) client.next_change = 0;
    if (cadence == Cadence::kLap || cadence == Cadence::kEvent) {
      send_kept(id, client);
      continue;
    }
    if (cadence == Cadence::kFrame && !has_frame_) continue;
    net::Bytes bytes = data_of(subscription, frame_.time, topics[channel].encode(frame_, options_.run));
    if (client.pace)
      deliver(id, client, std::move(bytes));
    else
      server_->send(id, std::move(bytes), true, delivery_of(cadence), channel + 1);
  }
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::Unsubscribe& message) {
  for (const std::uint32_t subscription : message.ids) {
    Client& client = clients_[id];
    if (std::erase_if(client.subscriptions,
                      [&](const auto& entry) { return entry.second == subscription; }) == 0) {
      warn(id, fmt::format("unsubscribe: there is no subscription {}", subscription));
    }
    if (!client.subscriptions.contains(past_channel())) client.past_before = 0;
  }
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::GetParameters& message) {
  if (options_.parameters == nullptr) return warn(id, "getParameters: this run has none");
  std::vector<foxglove::Parameter> values;
  if (message.names.empty()) values = options_.parameters->list();
  for (const std::string& name : message.names) {
    if (auto parameter = options_.parameters->get(name)) values.push_back(std::move(*parameter));
  }
  send_text(id, foxglove::parameter_values(values, message.request));
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::SetParameters& message) {
  if (options_.parameters == nullptr) return warn(id, "setParameters: this run has none");
  std::vector<foxglove::Parameter> values;
  const bool is_allowed = clients_[id].may_control;
  if (!is_allowed) warn(id, fmt::format("setParameters: {}", kWatchOnly));
  for (const foxglove::Parameter& parameter : message.parameters) {
    if (const Result<void> result = is_allowed ? options_.parameters->set(parameter) : Result<void>{};
        !result)
      warn(id, result.error().message);
    // Answer with the value that holds now, also after a refusal, so that the viewer's slider shows it.
    if (auto now = options_.parameters->get(parameter.name)) values.push_back(std::move(*now));
  }
  if (message.request) send_text(id, foxglove::parameter_values(values, message.request));
  // A choice of preset changes other parameters as well.
  for (foxglove::Parameter& other : options_.parameters->news()) {
    const bool is_listed = std::any_of(values.begin(), values.end(), [&](const foxglove::Parameter& value) {
      return value.name == other.name;
    });
    if (!is_listed) values.push_back(std::move(other));
  }
  send_parameters(values);
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::SubscribeParameters& message) {
  if (options_.parameters == nullptr)
    return warn(id, "subscribeParameterUpdates: this run has no parameters");
  Client& client = clients_[id];
  if (message.names.empty()) client.wants_all_parameters = true;
  // Drop unknown names, so that a client cannot fill the memory.
  for (const std::string& name : message.names) {
    if (options_.parameters->get(name)) client.wanted_parameters.insert(name);
  }
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::UnsubscribeParameters& message) {
  Client& client = clients_[id];
  if (message.names.empty()) {
    client.wants_all_parameters = false;
    client.wanted_parameters.clear();
  }
  for (const std::string& name : message.names) client.wanted_parameters.erase(name);
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::CallService& call) {
  if (call.service >= services_.size()) {
    return send_text(id,
                     foxglove::service_failure(call, fmt::format("there is no service {}", call.service)));
  }
  if (call.encoding != "cdr") {
    return send_text(id, foxglove::service_failure(call, "requests must be encoded as cdr"));
  }
  if (!clients_[id].may_control) return send_text(id, foxglove::service_failure(call, kWatchOnly));
  const Result<std::string> done = services_[call.service].call(call.payload);
  if (!done && done.error().code == ErrorCode::kParse) {
    return send_text(id, foxglove::service_failure(call, done.error().message));
  }
  const std::string answer =
      protocol::encode_service_response(done.has_value(), done ? *done : done.error().message);
  deliver(id, clients_[id], std::make_shared<const std::string>(foxglove::service_response(call, answer)));
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::Received& message) {
  Client& client = clients_[id];
  if (!client.pace) return warn(id, "received: the address of this connection does not ask for pacing");
  client.pace->received(message.bytes, now());
  client.heard = message;
  client.heard_at = now();
  serve(id, client);
}

}  // namespace chicane::wire
