// SPDX-License-Identifier: MIT
#include "chicane/wire/viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

namespace chicane::wire {
namespace {

namespace foxglove = protocol::foxglove;
using protocol::Cadence;

/// Topic number of the time for net::Delivery::kNewest; channels use their own number plus one.
constexpr std::uint32_t kTimeTopic = 1'000'000;

constexpr std::size_t kMostWaiting = 100;  // operators between the upgrade and its end
constexpr std::size_t kMostLaps = 1000;    // kept for viewers that come later

constexpr std::size_t kLapPage = 32;  // laps that are sent before the viewer has read those before

constexpr std::string_view kWatchOnly =
    "this connection may watch only; connect with the token of the link that the program printed to control";
constexpr std::string_view kTrigger = "std_srvs/srv/Trigger";
constexpr std::string_view kSetBool = "std_srvs/srv/SetBool";

std::vector<foxglove::Channel> channels() {
  std::vector<foxglove::Channel> list;
  for (const protocol::RosTopic& topic : protocol::ros_topics()) {
    list.push_back({static_cast<std::uint32_t>(list.size()), topic.name, topic.type, topic.schema});
  }
  return list;
}

std::uint32_t channel_of(Cadence cadence) {
  const auto& topics = protocol::ros_topics();
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const protocol::RosTopic& topic) { return topic.cadence == cadence; });
  return static_cast<std::uint32_t>(found - topics.begin());
}

std::uint32_t change_channel() {
  static const auto channel = channel_of(Cadence::kEvent);
  return channel;
}

std::uint32_t lap_channel() {
  static const auto channel = channel_of(Cadence::kLap);
  return channel;
}

/// A frame is stale once the next one is there; descriptions of the run must arrive.
net::Delivery delivery_of(Cadence cadence) {
  return cadence == Cadence::kFrame ? net::Delivery::kNewest : net::Delivery::kReliable;
}

std::function<Result<std::string>(std::string_view)> trigger(std::function<Result<void>()> action,
                                                             std::string done) {
  return [action = std::move(action), done = std::move(done)](std::string_view) -> Result<std::string> {
    if (const Result<void> result = action(); !result) return fail(result.error());
    return done;
  };
}

}  // namespace

ViewerEndpoint::ViewerEndpoint(ViewerOptions options)
    : options_{std::move(options)},
      session_{fmt::format("{:x}", std::chrono::system_clock::now().time_since_epoch().count())} {
  if (options_.services.pause) {
    offer("/pause", kSetBool, [this](std::string_view request) -> Result<std::string> {
      const std::optional<bool> paused = protocol::decode_set_bool(request);
      if (!paused) return fail(ErrorCode::kParse, "/pause: expected one boolean in CDR");
      if (const Result<void> result = options_.services.pause(*paused); !result) return fail(result.error());
      set_paused(*paused);
      return *paused ? "paused" : "running";
    });
  }
  if (options_.services.step) offer("/step", kTrigger, trigger(options_.services.step, "one step"));
  if (options_.services.reset) offer("/reset", kTrigger, trigger(options_.services.reset, "reset"));
}

void ViewerEndpoint::offer(std::string_view name, std::string_view type,
                           std::function<Result<std::string>(std::string_view)> call) {
  const auto id = static_cast<std::uint32_t>(services_.size());
  services_.push_back(
      {{id, name, type, protocol::service_request_schema(type), protocol::service_response_schema()},
       std::move(call)});
}

void ViewerEndpoint::set_run(protocol::Run run) {
  on_network([this, run = std::move(run)] {
    const protocol::Run before = std::exchange(options_.run, run);
    options_.run.building = before.building;
    options_.run.is_paused = before.is_paused;
    send_cadence(Cadence::kRun);
    send_cadence(Cadence::kRoad);
    send_cadence(Cadence::kLimit);
  });
}

void ViewerEndpoint::set_limit(lap_time::LimitAnswer answer) {
  on_network([this, answer = std::move(answer)] {
    options_.run.limit = answer;
    send_cadence(Cadence::kLimit);
  });
}

void ViewerEndpoint::set_paused(bool paused) {
  change_run([paused](protocol::Run& run) { run.is_paused = paused; });
}

void ViewerEndpoint::change_run(std::function<void(protocol::Run&)> change) {
  on_network([this, change = std::move(change)] {
    change(options_.run);
    send_cadence(Cadence::kRun);
  });
}

void ViewerEndpoint::on_network(std::function<void()> task) {
  if (server_ == nullptr) return task();
  server_->run_after(std::chrono::nanoseconds{0}, std::move(task));
}

void ViewerEndpoint::on_start(net::Server& server) {
  server_ = &server;
  schedule();
}

void ViewerEndpoint::schedule() {
  const std::chrono::duration<double> period{1.0 / std::clamp(options_.rate_limit, 1e-3, 1e3)};
  server_->run_after(std::chrono::duration_cast<std::chrono::nanoseconds>(period), [this] {
    schedule();
    tick();
  });
}

void ViewerEndpoint::tick() {
  tell_changes();
  note_lap();
  if (!latest_.take(frame_)) return;
  note_frame();
  const auto time =
      std::make_shared<const std::string>(foxglove::time_message(protocol::to_nanoseconds(frame_.time)));
  for (const auto& [id, client] : clients_) {
    if (!client.subscriptions.empty()) server_->send(id, time, true, net::Delivery::kNewest, kTimeTopic);
  }
  send_cadence(Cadence::kFrame);
}

/// The laps of a run that has begun anew are not those of the one before.
void ViewerEndpoint::note_frame() {
  if (has_frame_ && frame_.cycle < cycle_) {
    laps_.clear();
    for (auto& [id, client] : clients_) client.next_lap = 0;
  }
  has_frame_ = true;
  cycle_ = frame_.cycle;
}

/// Changes that the run has taken up go out in order; parameters that have another value, to those who
/// follow them.
void ViewerEndpoint::tell_changes() {
  if (options_.parameters == nullptr) return;
  for (const telemetry::Change& change : options_.parameters->applied()) {
    const std::string payload =
        protocol::encode_change(change.time, change.cycle, change.name.view(), change.value.view());
    for (const auto& [id, client] : clients_) {
      const auto wanted = client.subscriptions.find(change_channel());
      if (wanted == client.subscriptions.end()) continue;
      server_->send(
          id, foxglove::message_data(wanted->second, protocol::to_nanoseconds(change.time), payload), true);
    }
  }
  options_.parameters->update();
  for (const std::string& sentence : options_.parameters->complaints()) {
    for (const auto& [id, client] : clients_) warn(id, sentence);
  }
  send_parameters(options_.parameters->news());
}

void ViewerEndpoint::send_parameters(const std::vector<foxglove::Parameter>& values) {
  if (values.empty()) return;
  for (const auto& [id, client] : clients_) {
    std::vector<foxglove::Parameter> wanted;
    std::copy_if(values.begin(), values.end(), std::back_inserter(wanted),
                 [&, &client = client](const foxglove::Parameter& value) {
                   return client.wants_all_parameters || client.wanted_parameters.contains(value.name);
                 });
    if (!wanted.empty()) send_text(id, foxglove::parameter_values(wanted));
  }
}

/// Keeps the laps of this run for viewers that come later.
void ViewerEndpoint::note_lap() {
  TimedLap completed;
  if (latest_lap_.take(completed)) {
    if (laps_.size() >= kMostLaps) {
      laps_.erase(laps_.begin());
      for (auto& [id, client] : clients_) client.next_lap -= client.next_lap > 0 ? 1 : 0;
    }
    telemetry::Frame frame;
    frame.completed_lap = completed.lap;
    laps_.emplace_back(completed.time, protocol::ros_topics()[lap_channel()].encode(frame, options_.run));
  }
  for (auto& [id, client] : clients_) send_laps(id, client);
}

/// A page of those that it has not been sent; the next one when it has read this. All at once would be more
/// than may wait for a connection.
void ViewerEndpoint::send_laps(net::ConnectionId id, Client& client) {
  const auto wanted = client.subscriptions.find(lap_channel());
  if (wanted == client.subscriptions.end() || client.next_lap >= laps_.size()) return;
  for (std::size_t room = kLapPage - std::min(kLapPage, server_->waiting(id));
       room > 0 && client.next_lap < laps_.size(); --room, ++client.next_lap) {
    const auto& [time, lap] = laps_[client.next_lap];
    server_->send(id, foxglove::message_data(wanted->second, protocol::to_nanoseconds(time), lap), true);
  }
}

void ViewerEndpoint::send_cadence(Cadence cadence) {
  const auto& topics = protocol::ros_topics();
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].cadence == cadence) send_channel(static_cast<std::uint32_t>(i));
  }
}

void ViewerEndpoint::send_channel(std::uint32_t channel) {
  const protocol::RosTopic& topic = protocol::ros_topics()[channel];
  const std::uint64_t time = protocol::to_nanoseconds(frame_.time);
  // Encoded for the first that wants it; viewers of one kind use the same subscription numbers and share
  // bytes.
  std::optional<std::string> payload;
  std::map<std::uint32_t, net::Bytes> by_subscription;
  for (const auto& [id, client] : clients_) {
    const auto wanted = client.subscriptions.find(channel);
    if (wanted == client.subscriptions.end()) continue;
    if (!payload) payload = topic.encode(frame_, options_.run);
    net::Bytes& bytes = by_subscription[wanted->second];
    if (!bytes)
      bytes = std::make_shared<const std::string>(foxglove::message_data(wanted->second, time, *payload));
    server_->send(id, bytes, true, delivery_of(topic.cadence), channel + 1);
  }
}

void ViewerEndpoint::send_text(net::ConnectionId id, std::string text) {
  server_->send(id, std::move(text), false);
}

void ViewerEndpoint::warn(net::ConnectionId id, std::string_view sentence) {
  send_text(id, foxglove::status(foxglove::StatusLevel::kError, sentence));
}

net::UpgradeAnswer ViewerEndpoint::on_upgrade(const net::UpgradeRequest& request) {
  if (!request.may_watch)
    return {.accept = false,
            .status = 403,
            .reason = "viewers need the token of the link that the program printed"};
  if (request.is_crowded) return {.accept = false, .status = 503, .reason = "too many viewers"};
  for (const std::string_view ours : kViewerSubprotocols) {
    if (std::find(request.subprotocols.begin(), request.subprotocols.end(), ours) !=
        request.subprotocols.end()) {
      if (operators_.size() >= kMostWaiting) operators_.erase(operators_.begin());
      if (request.may_control) operators_.insert(request.id);
      return {.accept = true, .subprotocol = std::string{ours}};
    }
  }
  return {.accept = false,
          .status = 400,
          .reason = "viewers must offer the sub-protocol foxglove.sdk.v1 or foxglove.websocket.v1"};
}

void ViewerEndpoint::on_open(net::ConnectionId id) {
  clients_[id] = {};
  clients_[id].may_control = operators_.erase(id) > 0;
  send_text(id, foxglove::server_info(
                    "chicane", session_,
                    {.parameters = options_.parameters != nullptr, .services = !services_.empty()}));
  send_text(id, foxglove::advertise(channels()));
  std::vector<foxglove::Service> services;
  for (const ServiceEntry& service : services_) services.push_back(service.description);
  if (!services.empty()) send_text(id, foxglove::advertise_services(services));
}

void ViewerEndpoint::on_close(net::ConnectionId id, std::string_view /*why*/) { clients_.erase(id); }

void ViewerEndpoint::on_message(net::ConnectionId id, std::string_view bytes, bool binary) {
  const Result<foxglove::ClientMessage> message = foxglove::parse(bytes, binary);
  if (!message) return warn(id, message.error().message);
  std::visit([&](const auto& content) { handle(id, content); }, *message);
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::Subscribe& message) {
  const auto& topics = protocol::ros_topics();
  for (const auto& [subscription, channel] : message.subscriptions) {
    if (channel >= topics.size()) {
      warn(id, fmt::format("subscribe: there is no channel {}", channel));
      continue;
    }
    if (!clients_[id].subscriptions.try_emplace(channel, subscription).second) {
      warn(id, fmt::format("subscribe: {} is subscribed to already", topics[channel].name));
      continue;
    }
    // What is known now, because the next change may be far away.
    if (topics[channel].cadence == Cadence::kLap) {
      clients_[id].next_lap = 0;
      send_laps(id, clients_[id]);
      continue;
    }
    if (topics[channel].cadence == Cadence::kEvent) continue;
    if (topics[channel].cadence == Cadence::kFrame && !has_frame_) continue;
    server_->send(id,
                  foxglove::message_data(subscription, protocol::to_nanoseconds(frame_.time),
                                         topics[channel].encode(frame_, options_.run)),
                  true, delivery_of(topics[channel].cadence), channel + 1);
  }
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::Unsubscribe& message) {
  for (const std::uint32_t subscription : message.ids) {
    if (std::erase_if(clients_[id].subscriptions,
                      [&](const auto& entry) { return entry.second == subscription; }) == 0) {
      warn(id, fmt::format("unsubscribe: there is no subscription {}", subscription));
    }
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
  for (const foxglove::Parameter& wish : message.parameters) {
    if (const Result<void> result = is_allowed ? options_.parameters->set(wish) : Result<void>{}; !result)
      warn(id, result.error().message);
    // The value that holds now, also after a refusal: the viewer's slider must not show another.
    if (auto now = options_.parameters->get(wish.name)) values.push_back(std::move(*now));
  }
  if (message.request) send_text(id, foxglove::parameter_values(values, message.request));
  // A choice of preset changes more than its own value.
  for (foxglove::Parameter& other : options_.parameters->news()) {
    const bool is_told = std::any_of(values.begin(), values.end(), [&](const foxglove::Parameter& value) {
      return value.name == other.name;
    });
    if (!is_told) values.push_back(std::move(other));
  }
  send_parameters(values);
}

void ViewerEndpoint::handle(net::ConnectionId id, const foxglove::SubscribeParameters& message) {
  if (options_.parameters == nullptr)
    return warn(id, "subscribeParameterUpdates: this run has no parameters");
  Client& client = clients_[id];
  if (message.names.empty()) client.wants_all_parameters = true;
  // Names that do not exist are dropped, so a client cannot make us remember more than there is.
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
  server_->send(id, foxglove::service_response(call, answer), true);
}

}  // namespace chicane::wire
