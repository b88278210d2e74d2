// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "chicane/net/detail/close_watch.hpp"

namespace boost::beast {
enum class role_type;  // headers show no library, and Beast's has the same line
}

namespace chicane::net {

/// The stream under a WebSocket, with a look at what arrives: Beast answers every close frame that breaks
/// RFC 6455 with 1002, and echoes a status of 5000 or more. `Parts::each(buffers, take)` calls `take` with
/// each buffer of a sequence.
template <class Stream, class Parts>
class WatchedStream : public Stream {
 public:
  using Stream::Stream;

  /// Called with the status that a wrong close frame has to be answered with, before Beast sees the frame.
  std::function<void(std::uint16_t)> on_wrong_close{};

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    return Stream::async_read_some(buffers, [this, buffers, next = std::forward<Handler>(handler)](
                                                auto error, std::size_t count) mutable {
      if (!error) look(buffers, count);
      next(error, count);
    });
  }

 private:
  void look(const auto& buffers, std::size_t count) {
    Parts::each(buffers, [&](std::string_view part) {
      const std::string_view arrived = part.substr(0, std::min(count, part.size()));
      count -= arrived.size();
      const auto answer = watch_.take(arrived);
      if (answer && on_wrong_close) on_wrong_close(*answer);
    });
  }

  CloseWatch watch_;
};

/// Found by Beast when a WebSocket ends.
template <class Stream, class Parts, class Handler>
void async_teardown(boost::beast::role_type role, WatchedStream<Stream, Parts>& stream, Handler&& handler) {
  async_teardown(role, static_cast<Stream&>(stream), std::forward<Handler>(handler));
}

}  // namespace chicane::net
