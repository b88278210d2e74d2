// SPDX-License-Identifier: MIT
// Live run inside a browser's worker: a server that exchanges messages with the page, and the run by the
// page's clock.
#include "chicane/live/worker_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/instruction_set.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/wire/endpoint.hpp"

namespace chicane::live {

WorkerServer::WorkerServer(net::ServerHandlers handlers, Send send)
    : handlers_{std::move(handlers)}, send_{std::move(send)} {
  if (handlers_.on_start) handlers_.on_start(*this);
}

bool WorkerServer::connect() {
  if (std::exchange(is_open_, false)) handlers_.on_close(kPage, endpoint_, "the page connects anew");
  held_.clear();
  in_flight_ = 0;
  net::UpgradeRequest request{.id = kPage, .target = "/viewer?past", .may_watch = true, .may_control = true};
  request.subprotocols = {std::string(wire::kViewerSubprotocols.front())};
  const net::UpgradeAnswer answer = handlers_.on_upgrade(request);
  if (!answer.accept) return false;
  is_open_ = true;
  endpoint_ = answer.endpoint;
  handlers_.on_open(kPage, endpoint_);
  return true;
}

void WorkerServer::receive(std::string_view bytes, bool binary) {
  if (is_open_) handlers_.on_message(kPage, endpoint_, bytes, binary);
}

void WorkerServer::acknowledge(std::size_t count) {
  in_flight_ -= std::min(count, in_flight_);
  flush();
}

void WorkerServer::pass_time(double now) {
  now_ = std::max(now_, now);
  // Tasks that are added by tasks run in the next call, so that this one ends.
  std::vector<std::function<void()>> due;
  const auto end = tasks_.upper_bound(now_);
  for (auto task = tasks_.begin(); task != end; ++task) due.push_back(std::move(task->second));
  tasks_.erase(tasks_.begin(), end);
  for (const auto& task : due) task();
}

void WorkerServer::send(net::ConnectionId to, net::Bytes bytes, bool binary, net::Delivery delivery,
                        std::uint32_t topic) {
  if (to != kPage || !is_open_) return;
  if (delivery == net::Delivery::kNewest) {
    const auto waiting = std::find_if(held_.begin(), held_.end(), [&](const Held& each) {
      return each.delivery == net::Delivery::kNewest && each.topic == topic;
    });
    if (waiting != held_.end()) {
      waiting->bytes = std::move(bytes);
      return;
    }
  }
  held_.push_back({std::move(bytes), binary, delivery, topic});
  flush();
}

std::size_t WorkerServer::waiting(net::ConnectionId id) const {
  return id == kPage ? held_.size() + in_flight_ : 0;
}

void WorkerServer::close(net::ConnectionId id, std::uint16_t /*code*/, std::string_view reason) {
  if (id == kPage && std::exchange(is_open_, false)) handlers_.on_close(kPage, endpoint_, reason);
}

void WorkerServer::run_after(std::chrono::nanoseconds delay, std::function<void()> task) {
  tasks_.emplace(now_ + std::chrono::duration<double>(delay).count(), std::move(task));
}

void WorkerServer::flush() {
  for (; in_flight_ < kInFlight && !held_.empty(); ++in_flight_) {
    const Held next = std::move(held_.front());
    held_.pop_front();
    send_(*next.bytes, next.binary);
  }
}

namespace {

constexpr const char* kNoLimit = "it is not computed in a page without a program; `chicane limit` does";
constexpr double kLateness = 0.1;  // [s] lateness by the clock beyond which missed time is skipped; chosen

protocol::Run worker_description(const run::ClosedLoop& loop) {
  protocol::Run run = description(loop);
  run.limit = {.why_not = kNoLimit};
  return run;
}

}  // namespace

WorkerRun::WorkerRun(std::unique_ptr<run::ClosedLoop> loop, WorkerServer::Send send)
    : loop_{std::move(loop)},
      settings_{with_viewer(viewer_, {.scenario = loop_->scenario(),
                                      .faults = protocol::fault_controls(),
                                      .build = [this](ChosenRun next) { request_ = std::move(next); },
                                      .built = [this]() -> std::optional<Result<void>> {
                                        if (!request_) return std::nullopt;
                                        auto built = build_run(*std::exchange(request_, std::nullopt),
                                                               &worker_description);
                                        if (!built) return fail(built.error());
                                        built_ = std::move(*built);
                                        return Result<void>{};
                                      }}),
                controls_.settings},
      viewer_{
          {.run = worker_description(*loop_), .services = run_services(controls_), .parameters = &settings_}},
      router_{nullptr, &viewer_},
      publisher_{viewer_, settings_} {
  hooks_.on_frame = [this](const telemetry::Frame& frame) {
    if (frame.begins && frame.cycle == 0) ended_.reset();
    publisher_.frame(frame);
  };
  hooks_.on_lap = [this](const telemetry::CompletedLap& lap) { publisher_.lap(lap); };
  hooks_.on_change = [this](const telemetry::Change& change) { publisher_.change(change); };
  begin_steps();
  wire::Pages pages = live_pages(settings_);
  pages["/run.json"] = [this] {
    return net::Content{.content_type = "application/json", .bytes = run_json()};
  };
  server_ = std::make_unique<WorkerServer>(router_.handlers(std::move(pages)), std::move(send));
}

Result<std::unique_ptr<WorkerRun>> WorkerRun::create(const scenario::Scenario& scenario,
                                                     WorkerServer::Send send) {
  auto loop = run::ClosedLoop::create(scenario);
  if (!loop) return fail(loop.error());
  return std::unique_ptr<WorkerRun>(new WorkerRun(std::move(*loop), std::move(send)));
}

void WorkerRun::begin_steps() {
  steps_.emplace(*loop_, 0.0, controls_, hooks_, run::LapPlanner::Clock::kVirtual);
  anchor_.reset();
}

void WorkerRun::advance(double now, const std::function<bool()>& go_on) {
  server_->pass_time(now);
  if (steps_->is_to_start_anew()) take_over();
  const bool is_moved = steps_->restart_if_wanted() || controls_.is_paused;
  if (is_moved || !anchor_ || anchor_->pace != loop_->pace()) anchor_ = {loop_->time(), now, loop_->pace()};
  if (controls_.is_paused) return drive_paused();
  const double until = anchor_->time + (now - anchor_->clock) * anchor_->pace;
  drive(until, go_on);
  if (std::fabs(loop_->time() - until) > kLateness * anchor_->pace) anchor_.reset();
}

void WorkerRun::drive(double until, const std::function<bool()>& go_on) {
  while (loop_->time() < until && !steps_->is_to_start_anew()) {
    if (steps_->advance() && !go_on()) return;
    if (!loop_->is_over()) continue;
    if (!ended_) ended_ = loop_->summary();
    publisher_.end(*ended_);
    loop_->drive_on();
    if (loop_->time() < publisher_.time()) return;  // drive_on() has put a lost car back at the start
  }
}

void WorkerRun::drive_paused() {
  steps_->finish_cycle();
  steps_->take_up_changes();
  if (steps_->is_to_start_anew()) return;
  if (steps_->is_unseen() || steps_->take_step())
    steps_->one_cycle();  // also the first one of a run, so that viewers see where it begins
}

void WorkerRun::take_over() {
  loop_ = std::move(built_->loop);
  viewer_.set_run(std::move(built_->description));
  ended_.reset();
  begin_steps();
  for (const telemetry::Change& choice : built_->choices) hooks_.on_change(choice);
  controls_.settings.pop();
  built_.reset();
}

std::string WorkerRun::run_json() const {
  const std::string hash = ended_ ? fmt::format("\"{:016x}\"", ended_->state_hash) : "null";
  return fmt::format(
      "{{\"time_s\":{:.3f},\"pace\":{},\"arithmetic\":\"{}\",\"state_hash\":{},\"laps\":{}}}\n",
      loop_->time(), loop_->pace(), arithmetic(chosen_instruction_set()), hash,
      ended_ ? ended_->laps.size() : 0);
}

}  // namespace chicane::live
