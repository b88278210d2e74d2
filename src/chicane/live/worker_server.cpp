// SPDX-License-Identifier: MIT
#include "chicane/live/worker_server.hpp"

#include <algorithm>
#include <utility>

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
  // What a task adds for now waits for the next call: nothing can go round for ever.
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

}  // namespace chicane::live
