// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "chicane/net/http_response.hpp"
#include "chicane/net/server.hpp"
#include "chicane/wire/sparse_log.hpp"

namespace chicane::wire {

/// What the program answers to GET beside the dashboard's files, by path ("/mode.json"). Called on the
/// network thread.
using Pages = std::map<std::string, std::function<net::Content()>, std::less<>>;

/// One dialect spoken on the shared port: the simulator's (serve.hpp) or the viewers' (viewer.hpp). It sees
/// only its own connections. All member functions are called on the network thread, one at a time, and must
/// not block.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  /// Before the first connection. `server` outlives every later call; its member functions may be used from
  /// any thread.
  virtual void on_start(net::Server& server) = 0;
  /// Accept or refuse in words. `UpgradeAnswer::endpoint` is the router's; leave it.
  [[nodiscard]] virtual net::UpgradeAnswer on_upgrade(const net::UpgradeRequest& request) = 0;
  virtual void on_open(net::ConnectionId id) = 0;
  virtual void on_message(net::ConnectionId id, std::string_view bytes, bool binary) = 0;
  /// Exactly once for each on_open, unless the server is destroyed first.
  virtual void on_close(net::ConnectionId id, std::string_view why) = 0;
};

/// The names under which viewers speak the Foxglove WebSocket protocol, the one they should prefer first.
inline constexpr std::array<std::string_view, 2> kViewerSubprotocols{"foxglove.sdk.v1",
                                                                     "foxglove.websocket.v1"};

/// Sends each connection of one server to the endpoint that speaks its dialect: a viewer's sub-protocol to
/// `viewer`, everything else (the original simulator offers none and asks for any path) to `simulator`.
/// Either may be null: its clients are refused in words.
class Router {
 public:
  /// `say` gets the reason of a refusal, once for each reason, on the network thread. May be empty.
  Router(Endpoint* simulator, Endpoint* viewer, std::function<void(std::string_view)> say = {})
      : endpoints_{simulator, viewer}, log_{std::move(say)} {}

  /// The router must outlive the server that was created with them. `pages` are answered to GET.
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

  static constexpr std::string_view kSocketIoPath = "/socket.io/";

  std::array<Endpoint*, 2> endpoints_;
  SparseLog log_;
};

}  // namespace chicane::wire
