// SPDX-License-Identifier: MIT
#include "chicane/wire/viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <utility>

namespace chicane::wire {
namespace {

namespace foxglove = protocol::foxglove;
using protocol::Cadence;

/// Topic number of the time for net::Delivery::kNewest; channels use their own number plus one.
constexpr std::uint32_t kTimeTopic = 1'000'000;

constexpr std::size_t kMostWaiting = 100;  // viewers between the upgrade and its end

// Kept messages that are sent before the viewer has read those before; with what else waits they stay below
// net::ServerOptions::max_queue.
constexpr std::size_t kPage = 192;

constexpr std::uint16_t kGoingAway = 1001;  // RFC 6455 §7.4.1

constexpr std::string_view kWatchOnly =
    "this connection may watch only; connect with the token of the link that the program printed to control";
constexpr std::string_view kTrigger = "std_srvs/srv/Trigger";
constexpr std::string_view kSetBool = "std_srvs/srv/SetBool";
constexpr std::string_view kAsk = "chicane_msgs/srv/Ask";

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

std::uint32_t frame_channel() {
  static const auto channel = channel_of(Cadence::kFrame);
  return channel;
}

/// Manual driving changes thirty times a second, which is of no interest later.
bool is_worth_keeping(const telemetry::Change& change) {
  return change.name.view() != "manual.steer" && change.name.view() != "manual.throttle";
}

bool asks_for_past(std::string_view target) {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return false;
  for (std::string_view rest = target.substr(query + 1); !rest.empty();) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    if (rest.substr(0, end) == "past") return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
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

std::function<Result<std::string>(std::string_view)> ask(
    std::string_view name, std::function<Result<std::string>(std::string_view)> service) {
  return [name, service = std::move(service)](std::string_view request) -> Result<std::string> {
    const std::optional<std::string> question = protocol::decode_ask(request);
    if (!question) return fail(ErrorCode::kParse, fmt::format("{}: expected one text in CDR", name));
    return service(*question);
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
  if (options_.services.what_if) offer("/what_if", kAsk, ask("/what_if", options_.services.what_if));
  if (options_.services.rival) offer("/rival", kAsk, ask("/rival", options_.services.rival));
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

void ViewerEndpoint::set_end(std::string kind, std::string reason) {
  change_run([kind = std::move(kind), reason = std::move(reason)](protocol::Run& run) {
    run.end = kind;
    run.end_reason = reason;
  });
}

void ViewerEndpoint::dismiss(std::chrono::milliseconds patience) {
  if (server_ == nullptr) return;
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + patience;
  std::promise<void> gone;
  std::set<net::ConnectionId> told;
  bool has_ticked = false;
  std::function<void()> look = [&] {
    if (!std::exchange(has_ticked, true)) tick();
    for (const auto& [id, client] : clients_) {
      const bool has_all = server_->waiting(id) == 0 && !client.next_frame;
      if (has_all && told.insert(id).second) server_->close(id, kGoingAway, "the run is over");
    }
    if (clients_.empty() || Clock::now() >= end) return gone.set_value();
    server_->run_after(std::chrono::milliseconds{5}, look);
  };
  server_->run_after(std::chrono::nanoseconds{0}, look);
  gone.get_future().wait();
}

void ViewerEndpoint::change_run(std::function<void(protocol::Run&)> change) {
  on_network([this, change = std::move(change)] {
    change(options_.run);
    send_cadence(Cadence::kRun);
  });
}

void ViewerEndpoint::on_network(std::function<void()> task) {
  std::unique_lock lock(starting_);
  if (server_ == nullptr) return task();
  lock.unlock();
  server_->run_after(std::chrono::nanoseconds{0}, std::move(task));
}

void ViewerEndpoint::on_start(net::Server& server) {
  const std::lock_guard lock(starting_);
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
  const bool is_new = latest_.take(frame_);
  const bool begins = is_new && has_frame_ && frame_.cycle < cycle_;
  if (begins && !std::exchange(has_forgotten_, false)) forget();  // before the changes of the run that begins
  tell_changes(begins);
  note_lap(begins);
  if (is_new) note_frame();
  for (auto& [id, client] : clients_) send_kept(id, client);
  if (!is_new) return;
  const auto time =
      std::make_shared<const std::string>(foxglove::time_message(protocol::to_nanoseconds(frame_.time)));
  for (const auto& [id, client] : clients_) {
    if (!client.subscriptions.empty()) server_->send(id, time, true, net::Delivery::kNewest, kTimeTopic);
  }
  send_cadence(Cadence::kFrame);
}

/// What was before a run began anew is not of this one.
void ViewerEndpoint::forget() {
  memory_.forget();
  ledger_.restart();
  if (!options_.run.end.empty()) set_end("", "");
}

void ViewerEndpoint::note_frame() {
  has_frame_ = true;
  cycle_ = frame_.cycle;
  memory_.add_frame(frame_.time, protocol::ros_topics()[frame_channel()].encode(frame_, options_.run));
}

/// Changes that the run has taken up go out in order; parameters that have another value, to those who
/// follow them. `begins`: the newest frame is of a run that began since the last look; of the changes since
/// then, only those that are not before it are of that run.
void ViewerEndpoint::tell_changes(bool begins) {
  if (options_.parameters == nullptr) return;
  for (const telemetry::Change& change : options_.parameters->applied()) {
    if (begins && change.cycle > frame_.cycle + 1) continue;
    if (change.starts_anew && !begins && !std::exchange(has_forgotten_, true)) forget();
    ledger_.add(change);
    const std::string payload =
        protocol::encode_change(change.time, change.cycle, change.name.view(), change.value.view());
    if (is_worth_keeping(change)) {
      memory_.add_change(change.time, payload);
      continue;  // send_kept() sends it
    }
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
void ViewerEndpoint::note_lap(bool begins) {
  TimedLap completed;
  if (!latest_lap_.take(completed)) return;
  if (begins && completed.time > frame_.time) return;  // of the run before
  telemetry::Frame frame;
  frame.completed_lap = completed.lap;
  options_.run.lap_setup = ledger_.setup(completed.time, completed.lap.lap_time);
  memory_.add_lap(completed.lap, completed.time,
                  protocol::ros_topics()[lap_channel()].encode(frame, options_.run));
}

/// A page of what it has not been sent; the next one when it has read this. All at once would be more than
/// may wait for a connection.
void ViewerEndpoint::send_kept(net::ConnectionId id, Client& client) {
  const auto send_page = [&](std::uint32_t channel, std::uint64_t& next, auto from) {
    const auto wanted = client.subscriptions.find(channel);
    if (wanted == client.subscriptions.end()) return true;
    for (std::size_t room = kPage - std::min(kPage, server_->waiting(id)); room > 0; --room) {
      const KeptMessage* message = (memory_.*from)(next);
      if (message == nullptr) return true;
      server_->send(
          id,
          foxglove::message_data(wanted->second, protocol::to_nanoseconds(message->time), message->payload),
          true);
      next = message->number + 1;
    }
    return false;
  };
  const bool has_laps = send_page(lap_channel(), client.next_lap, &RunMemory::lap_from);
  send_page(change_channel(), client.next_change, &RunMemory::change_from);
  if (!client.next_frame || !has_laps) return;  // the table before the curves
  const bool has_all = send_page(frame_channel(), *client.next_frame, &RunMemory::frame_from);
  if (has_all) client.next_frame.reset();
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
    if (channel == frame_channel() && client.next_frame) continue;  // the past comes first
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
      if (upgrades_.size() >= kMostWaiting) upgrades_.erase(upgrades_.begin());
      Client& client = upgrades_[request.id];
      client.may_control = request.may_control;
      client.wants_past = asks_for_past(request.target);
      return {.accept = true, .subprotocol = std::string{ours}};
    }
  }
  return {.accept = false,
          .status = 400,
          .reason = "viewers must offer the sub-protocol foxglove.sdk.v1 or foxglove.websocket.v1"};
}

void ViewerEndpoint::on_open(net::ConnectionId id) {
  const auto upgrade = upgrades_.extract(id);
  clients_[id] = upgrade.empty() ? Client{} : upgrade.mapped();
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
    Client& client = clients_[id];
    if (channel == frame_channel() && client.wants_past) {
      client.next_frame = 0;  // from the next tick on: what describes the run comes first
      continue;
    }
    const Cadence cadence = topics[channel].cadence;
    if (cadence == Cadence::kLap) client.next_lap = 0;
    if (cadence == Cadence::kEvent) client.next_change = 0;
    if (cadence == Cadence::kLap || cadence == Cadence::kEvent) {
      send_kept(id, client);
      continue;
    }
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
  for (const foxglove::Parameter& parameter : message.parameters) {
    if (const Result<void> result = is_allowed ? options_.parameters->set(parameter) : Result<void>{};
        !result)
      warn(id, result.error().message);
    // The value that holds now, also after a refusal: the viewer's slider must not show another.
    if (auto now = options_.parameters->get(parameter.name)) values.push_back(std::move(*now));
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
