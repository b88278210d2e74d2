// SPDX-License-Identifier: MIT
// Parts that all servers of this module share: endpoint of one protocol, router between the protocols of one
// port, pages, rate-limited log, median.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/median.hpp"
#include "chicane/net/http_response.hpp"
#include "chicane/net/server.hpp"

namespace chicane::wire {

/// Log for the terminal with a bounded rate of lines, whatever a peer sends. One thread.
class SparseLog {
 public:
  explicit SparseLog(std::function<void(std::string_view)> sink) : sink_{std::move(sink)} {}

  /// Logs a line at once: for lines that no peer can cause at will.
  void say(std::string_view line) const {
    if (sink_) sink_(line);
  }

  /// Logs a line at most once a second, with the number of equal lines suppressed before. A line unlike the
  /// last kRemembered is logged at once: kNewLines of them, then one a second.
  void complain(std::string_view line) {
    const Clock::time_point now = Clock::now();
    const auto known =
        std::find_if(said_.begin(), said_.end(), [&](const Said& each) { return each.line == line; });
    if (known == said_.end()) return say_new(line, now);
    if (now - known->at < kPause) {
      ++known->held_back;
      return;
    }
    known->at = now;
    const int more = std::exchange(known->held_back, 0);
    say(more == 0 ? std::string(line) : std::string(line) + " (" + std::to_string(more) + " like it before)");
  }

  /// Logs `line` unless a line of the same `reason` was logged before. Logs nothing after kReasons reasons.
  void say_once(std::string_view reason, std::string_view line) {
    if (reasons_.size() == kReasons || std::find(reasons_.begin(), reasons_.end(), reason) != reasons_.end())
      return;
    reasons_.emplace_back(reason);
    say(line);
  }

  // Chosen.
  static constexpr std::size_t kRemembered = 8;  ///< newest different lines that are remembered
  static constexpr int kNewLines = 4;            ///< different lines that may come in one burst
  static constexpr std::size_t kReasons = 32;    ///< reasons of say_once()

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPause{1};  ///< least time between equal lines
  /// Line that was logged.
  struct Said {
    std::string line;
    Clock::time_point at{};  ///< time of its last output
    int held_back = 0;       ///< equal lines suppressed since
  };

  /// Logs a line unlike the remembered ones, if the burst is not used up.
  void say_new(std::string_view line, Clock::time_point now) {
    const double pause = std::chrono::duration<double>(now - refilled_) / kPause;
    budget_ = std::min(double{kNewLines}, budget_ + pause);
    refilled_ = now;
    if (budget_ < 1.0) return;
    budget_ -= 1.0;
    if (said_.size() == kRemembered) said_.pop_front();
    said_.push_back({std::string(line), now});
    say(line);
  }

  std::function<void(std::string_view)> sink_;  ///< gets the lines; may be empty
  std::deque<Said> said_;                       ///< newest different lines, the oldest first
  std::vector<std::string> reasons_;            ///< reasons of say_once() so far
  Clock::time_point refilled_{};                ///< time of the last change of budget_
  double budget_ = kNewLines;                   ///< different lines that may come now
};

/// Pages by path ("/mode.json"), answered to GET besides the files of the dashboard. Called on the network
/// thread.
using Pages = std::map<std::string, std::function<net::Content()>, std::less<>>;

/// Median of the newest kCount values. No allocation.
class RecentMedian {
  static constexpr std::size_t kCount = 9;  ///< chosen: four outliers do not change the median much

 public:
  void reset() noexcept { count_ = 0; }
  void add(double value) noexcept { values_[count_++ % values_.size()] = value; }
  /// Median, or `otherwise` without a value.
  [[nodiscard]] double value(double otherwise) const noexcept {
    if (count_ == 0) return otherwise;
    std::array<double, kCount> sorted = values_;
    return median(std::span(sorted).first(std::min(count_, sorted.size())));
  }

 private:
  std::array<double, kCount> values_{};  ///< ring of the newest values
  std::size_t count_ = 0;                ///< values added since reset()
};

/// Whether the query of a request's target, as in "/path?a=1&b=2", contains `item`.
[[nodiscard]] inline bool asks_for(std::string_view item, std::string_view target) {
  for (std::size_t begin = target.find('?'); begin != std::string_view::npos;) {
    const std::size_t end = target.find('&', ++begin);
    if (target.substr(begin, end - begin) == item) return true;
    begin = end;
  }
  return false;
}

/// One protocol spoken on the shared port: the simulator's (serve.hpp) or the viewers' (viewer.hpp). An
/// endpoint sees its own connections only. Its functions are called on the network thread, and must not
/// block.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  /// Called before the first connection. `server` outlives every later call; its member functions may be used
  /// from any thread.
  virtual void on_start(net::Server& server) = 0;
  /// Accepts a connection, or refuses it with a reason. The router sets UpgradeAnswer::endpoint.
  [[nodiscard]] virtual net::UpgradeAnswer on_upgrade(const net::UpgradeRequest& request) = 0;
  virtual void on_open(net::ConnectionId id) = 0;
  virtual void on_message(net::ConnectionId id, std::string_view bytes, bool binary) = 0;
  /// Called once for each on_open(), unless the server is destroyed before.
  virtual void on_close(net::ConnectionId id, std::string_view why) = 0;
};

/// Names of the Foxglove WebSocket protocol, the preferred one first.
inline constexpr std::array<std::string_view, 2> kViewerSubprotocols{"foxglove.sdk.v1",
                                                                     "foxglove.websocket.v1"};

/// Sends each connection of one server to the endpoint of its protocol: connections that offer a sub-protocol
/// of viewers to `viewer`, all others to `simulator`, because the original simulator offers none and uses any
/// path. Either may be null: its clients are refused with a reason.
class Router {
 public:
  /// `say` gets the reason of a refusal, once for each reason, on the network thread. May be empty.
  Router(Endpoint* simulator, Endpoint* viewer, std::function<void(std::string_view)> say = {})
      : endpoints_{simulator, viewer}, log_{std::move(say)} {}

  /// Handlers for a server, which the router must outlive. `pages` are answered to GET.
  [[nodiscard]] net::ServerHandlers handlers(Pages pages = {}) {
    return {
        .on_start =
            [this](net::Server& server) {
              for (Endpoint* endpoint : endpoints_) {
                if (endpoint != nullptr) endpoint->on_start(server);
              }
            },
        .on_upgrade = [this](const net::UpgradeRequest& request) { return answer(request); },
        .on_open = [this](net::ConnectionId id, int to) { at(to).on_open(id); },
        .on_message = [this](net::ConnectionId id, int to, std::string_view bytes,
                             bool binary) { at(to).on_message(id, bytes, binary); },
        .on_close = [this](net::ConnectionId id, int to, std::string_view why) { at(to).on_close(id, why); },
        .on_get = [pages = std::move(pages)](std::string_view path) -> std::optional<net::Content> {
          const auto page = pages.find(path);
          if (page == pages.end()) return std::nullopt;
          return page->second();
        },
        .on_no_upgrade = [](std::string_view target) -> std::string {
          if (!target.starts_with(kSocketIoPath)) return "";
          return "Socket.IO by polling is not served: use transport=websocket, in a client {transports: "
                 "[\"websocket\"]}";
        },
        .on_refused =
            [this](std::string_view peer, std::string_view words) {
              log_.say_once(words, "refused " + std::string(peer) + ": " + std::string(words));
            },
    };
  }

 private:
  [[nodiscard]] Endpoint& at(int index) { return *endpoints_[static_cast<std::size_t>(index)]; }

  [[nodiscard]] net::UpgradeAnswer answer(const net::UpgradeRequest& request) {
    const bool is_viewer =
        std::any_of(request.subprotocols.begin(), request.subprotocols.end(), [](const std::string& offered) {
          return std::find(kViewerSubprotocols.begin(), kViewerSubprotocols.end(), offered) !=
                 kViewerSubprotocols.end();
        });
    const int index = is_viewer ? 1 : 0;
    if (endpoints_[static_cast<std::size_t>(index)] == nullptr) {
      return {.accept = false,
              .status = 404,
              .reason =
                  is_viewer
                      ? "this program shows nothing to viewers"
                      : "this program has its own simulator: viewers offer the sub-protocol foxglove.sdk.v1 "
                        "or foxglove.websocket.v1"};
    }
    net::UpgradeAnswer answer = at(index).on_upgrade(request);
    answer.endpoint = index;
    return answer;
  }

  static constexpr std::string_view kSocketIoPath = "/socket.io/";  ///< path of Socket.IO clients

  std::array<Endpoint*, 2> endpoints_;  ///< simulator, viewer
  SparseLog log_;
};

}  // namespace chicane::wire
