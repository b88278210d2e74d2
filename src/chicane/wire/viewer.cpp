// SPDX-License-Identifier: MIT
// Endpoint of viewers: sends frames, laps, changes and parameters to each viewer at the pace of its link.
#include "chicane/wire/viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <memory>
#include <utility>

#include "chicane/wire/detail/viewer_channels.hpp"

namespace chicane::wire {

namespace foxglove = protocol::foxglove;
using detail::channel_of;
using detail::data_of;
using detail::delivery_of;
using detail::past_channel;
using protocol::Cadence;

namespace {

// Chosen, except for kGoingAway.

// Topic of the time for net::Delivery::kNewest; channels use their own number plus one.
constexpr std::uint32_t kTimeTopic = 1'000'000;

constexpr std::size_t kMostWaiting = 100;  // most viewers between upgrade and connection

// Most messages that wait for a viewer to read, so that kept messages stay below
// net::ServerOptions::max_queue.
constexpr std::size_t kPage = 192;

// Least time between newest frames, and between plans, while past frames are sent over a slow link [s]. A
// plan is ten times as large as the rest of a frame.
constexpr double kNewestBesidePast = 0.1;
constexpr double kPlanBesidePast = 0.5;
// Bytes beyond a viewer's window that the newest frame may use, so that it does not wait for past frames.
constexpr std::size_t kReserve = 4096;

constexpr std::uint16_t kGoingAway = 1001;  // close code by RFC 6455 §7.4.1

constexpr std::string_view kTrigger = "std_srvs/srv/Trigger";
constexpr std::string_view kSetBool = "std_srvs/srv/SetBool";
constexpr std::string_view kAsk = "chicane_msgs/srv/Ask";

/// Channels that a viewer is offered.
std::vector<foxglove::Channel> channels(bool with_past) {
  std::vector<foxglove::Channel> list;
  for (const protocol::RosTopic& topic : protocol::ros_topics()) {
    list.push_back({static_cast<std::uint32_t>(list.size()), topic.name, topic.type, topic.schema});
  }
  const protocol::RosTopic& frame = protocol::ros_topics()[channel_of(Cadence::kFrame)];
  if (with_past) list.push_back({past_channel(), detail::kPastTopic, frame.type, frame.schema});
  return list;
}

/// Service without arguments; `done` is the sentence of its success.
std::function<Result<std::string>(std::string_view)> trigger(std::function<Result<void>()> action,
                                                             std::string done) {
  return [action = std::move(action), done = std::move(done)](std::string_view) -> Result<std::string> {
    if (const Result<void> result = action(); !result) return fail(result.error());
    return done;
  };
}

/// Service with one text as its argument.
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

void ViewerEndpoint::dismiss(const Patience& patience) {
  if (server_ == nullptr) return;
  using Steady = std::chrono::steady_clock;
  const auto begin = Steady::now();
  auto heard = begin;
  std::map<net::ConnectionId, std::pair<std::size_t, std::uint64_t>> reading;  // messages waiting, bytes read
  std::promise<void> gone;
  std::set<net::ConnectionId> informed;
  bool has_ticked = false;
  std::function<void()> look = [&] {
    if (!std::exchange(has_ticked, true)) tick();
    for (const auto& [id, client] : clients_) {
      const std::pair<std::size_t, std::uint64_t> now{server_->waiting(id),
                                                      client.pace ? client.pace->received() : 0};
      if (std::exchange(reading[id], now) != now) heard = Steady::now();
      if (has_all(id, client) && informed.insert(id).second) {
        heard = Steady::now();
        server_->close(id, kGoingAway, "the run is over");
      }
    }
    const auto now = Steady::now();
    if (clients_.empty() || now >= heard + patience.silent || now >= begin + patience.whole)
      return gone.set_value();
    server_->run_after(std::chrono::milliseconds{5}, look);
  };
  server_->run_after(std::chrono::nanoseconds{0}, look);
  gone.get_future().wait();
}

bool ViewerEndpoint::has_all(net::ConnectionId id, const Client& client) const {
  const auto is_sent = [&](std::uint32_t channel, const KeptMessage* next) {
    return next == nullptr || !client.subscriptions.contains(channel);
  };
  return server_->waiting(id) == 0 && client.past_before == 0 && client.owed.empty() && !client.is_behind &&
         is_sent(channel_of(Cadence::kLap), memory_.lap_from(client.next_lap)) &&
         is_sent(channel_of(Cadence::kEvent), memory_.change_from(client.next_change));
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
  if (begins && !std::exchange(has_forgotten_, false)) forget();  // before changes of the new run are kept
  tell_changes(begins);
  note_lap(begins);
  if (is_new) note_frame();
  if (is_new) {
    const auto time =
        std::make_shared<const std::string>(foxglove::time_message(protocol::to_nanoseconds(frame_.time)));
    for (auto& [id, client] : clients_) {
      client.is_behind = client.pace.has_value();
      if (!client.pace && !client.subscriptions.empty())
        server_->send(id, time, true, net::Delivery::kNewest, kTimeTopic);
    }
    send_cadence(Cadence::kFrame);
  }
  for (auto& [id, client] : clients_) serve(id, client);
}

void ViewerEndpoint::serve(net::ConnectionId id, Client& client) {
  send_newest(id, client);
  send_owed(id, client);
  send_kept(id, client);
}

void ViewerEndpoint::send_owed(net::ConnectionId id, Client& client) {
  while (!client.owed.empty() && has_room(id, client)) {
    const std::uint32_t channel = *client.owed.begin();
    client.owed.erase(client.owed.begin());
    const auto wanted = client.subscriptions.find(channel);
    if (wanted == client.subscriptions.end()) continue;
    const protocol::RosTopic& topic = protocol::ros_topics()[channel];
    deliver(id, client, data_of(wanted->second, frame_.time, topic.encode(frame_, options_.run)));
  }
}

void ViewerEndpoint::forget() {
  memory_.forget();
  ledger_.restart();
  if (!options_.run.end.empty()) set_end("", "");
}

void ViewerEndpoint::note_frame() {
  has_frame_ = true;
  cycle_ = frame_.cycle;
  memory_.add_frame(frame_.time,
                    protocol::ros_topics()[channel_of(Cadence::kFrame)].encode(frame_, options_.run));
}

void ViewerEndpoint::tell_changes(bool begins) {
  if (options_.parameters == nullptr) return;
  for (const telemetry::Change& change : options_.parameters->applied()) {
    if (begins && change.cycle > frame_.cycle + 1) continue;  // belongs to the earlier run
    if (change.starts_anew && !begins && !std::exchange(has_forgotten_, true)) forget();
    ledger_.add(change);
    const std::string payload =
        protocol::encode_change(change.time, change.cycle, change.name.view(), change.value.view());
    // A person's controls change thirty times a second: send them, but keep none for later viewers.
    if (change.name.view() != "manual.steer" && change.name.view() != "manual.throttle") {
      memory_.add_change(change.time, payload);
      continue;  // send_kept() sends it
    }
    for (auto& [id, client] : clients_) {
      const auto wanted = client.subscriptions.find(channel_of(Cadence::kEvent));
      if (wanted == client.subscriptions.end()) continue;
      deliver(id, client, data_of(wanted->second, change.time, payload));
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

void ViewerEndpoint::note_lap(bool begins) {
  TimedLap completed;
  if (!latest_lap_.take(completed)) return;
  if (begins && completed.time > frame_.time) return;  // belongs to the run before
  telemetry::Frame frame;
  frame.completed_lap = completed.lap;
  options_.run.lap_setup = ledger_.setup(completed.time, completed.lap.lap_time);
  memory_.add_lap(completed.lap, completed.time,
                  protocol::ros_topics()[channel_of(Cadence::kLap)].encode(frame, options_.run));
}

void ViewerEndpoint::send_newest(net::ConnectionId id, Client& client) {
  if (!client.pace || !client.is_behind || !has_frame_ || server_->waiting(id) >= kPage ||
      !client.pace->has_room(kReserve))
    return;
  if (client.past_before > 0 && now() - client.newest_sent_at < kNewestBesidePast) return;
  if (client.heard) send_text(id, foxglove::heard(client.heard->at, now() - client.heard_at));
  client.heard.reset();
  client.is_behind = false;
  client.newest_sent_at = now();
  const bool is_whole = client.past_before == 0 || now() - client.whole_sent_at >= kPlanBesidePast;
  if (is_whole) client.whole_sent_at = now();
  if (client.subscriptions.empty()) return;
  deliver(id, client,
          std::make_shared<const std::string>(foxglove::time_message(protocol::to_nanoseconds(frame_.time))));
  const auto& topics = protocol::ros_topics();
  for (const auto& [channel, subscription] : client.subscriptions) {
    if (channel >= topics.size() || topics[channel].cadence != Cadence::kFrame) continue;
    if (!is_whole && !detail::goes_with_frame(topics[channel].name)) continue;
    deliver(id, client, data_of(subscription, frame_.time, topics[channel].encode(frame_, options_.run)));
  }
}

// All messages at once would exceed a connection's queue.
void ViewerEndpoint::send_kept(net::ConnectionId id, Client& client) {
  const auto send_page = [&](std::uint32_t channel, std::uint64_t& next, auto from) {
    const auto wanted = client.subscriptions.find(channel);
    if (wanted == client.subscriptions.end()) return true;
    for (std::size_t room = room_for(id, client); room > 0 && has_room(id, client); --room) {
      const KeptMessage* message = (memory_.*from)(next);
      if (message == nullptr) return true;
      deliver(id, client, data_of(wanted->second, message->time, message->payload));
      next = message->number + 1;
    }
    return false;
  };
  const bool has_laps = send_page(channel_of(Cadence::kLap), client.next_lap, &RunMemory::lap_from);
  send_page(channel_of(Cadence::kEvent), client.next_change, &RunMemory::change_from);
  if (has_laps && client.past_before > 0) send_past(id, client);  // viewers show laps before past frames
}

void ViewerEndpoint::send_past(net::ConnectionId id, Client& client) {
  const std::uint32_t subscription = client.subscriptions.at(past_channel());
  const std::size_t room = room_for(id, client);
  std::size_t sent = 0;
  for (; sent < room && has_room(id, client) && client.past_before > 0; ++sent) {
    const KeptMessage* message = memory_.frame_before(client.past_before);
    client.past_before = message != nullptr ? message->number : 0;
    if (message != nullptr) deliver(id, client, data_of(subscription, message->time, message->payload));
  }
  if (sent > 0) send_text(id, foxglove::past_left(memory_.frames_before(client.past_before)));
}

std::size_t ViewerEndpoint::room_for(net::ConnectionId id, const Client& client) const {
  return has_room(id, client) ? kPage - server_->waiting(id) : 0;
}

bool ViewerEndpoint::has_room(net::ConnectionId id, const Client& client) const {
  return server_->waiting(id) < kPage && (!client.pace || client.pace->has_room());
}

void ViewerEndpoint::deliver(net::ConnectionId id, Client& client, net::Bytes bytes) {
  if (client.pace) client.pace->sent(bytes->size(), now());
  server_->send(id, std::move(bytes), true);
}

double ViewerEndpoint::now() const {
  if (options_.clock) return options_.clock();
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
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
  // Encode once, for the first subscriber. Viewers of one kind use equal subscription numbers and share
  // bytes.
  std::optional<std::string> payload;
  std::map<std::uint32_t, net::Bytes> by_subscription;
  for (auto& [id, client] : clients_) {
    const auto wanted = client.subscriptions.find(channel);
    if (wanted == client.subscriptions.end()) continue;
    if (client.pace && topic.cadence == Cadence::kFrame) continue;  // sent by send_newest()
    if (client.owed.contains(channel)) continue;                    // sent by send_owed()
    if (!payload) payload = topic.encode(frame_, options_.run);
    net::Bytes& bytes = by_subscription[wanted->second];
    if (!bytes)
      bytes = std::make_shared<const std::string>(foxglove::message_data(wanted->second, time, *payload));
    if (client.pace)
      deliver(id, client, bytes);
    else
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
      client.wants_past = asks_for("past", request.target);
      if (asks_for("paced", request.target)) client.pace.emplace();
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
  send_text(id, foxglove::advertise(channels(clients_[id].wants_past)));
  std::vector<foxglove::Service> services;
  for (const ServiceEntry& service : services_) services.push_back(service.description);
  if (!services.empty()) send_text(id, foxglove::advertise_services(services));
}

void ViewerEndpoint::on_close(net::ConnectionId id, std::string_view /*why*/) { clients_.erase(id); }

}  // namespace chicane::wire
