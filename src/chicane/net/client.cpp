// SPDX-License-Identifier: MIT
// WebSocket client: connects, sends the upgrade, and reads and writes frames.
#include "chicane/net/client.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/uuid/detail/sha1.hpp>
#include <cerrno>
#include <cstring>
#include <random>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "chicane/base/text.hpp"

namespace chicane::net {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::milliseconds;

constexpr std::size_t kMaxMessage = 1U << 20U;  // [byte] chosen: a reply with hundreds of points has 20 kB
constexpr std::size_t kMaxHeader = 1U << 14U;   // [byte] chosen: limit of an upgrade's answer
constexpr std::size_t kMaxReason = 200;         // [byte] chosen: shown of a refusal's text, two lines
constexpr Milliseconds kSendTimeout{5000};      // chosen: a server that reads nothing for so long is lost
constexpr Milliseconds kPongTimeout{1000};      // chosen: short, because receive() waits for it
constexpr Milliseconds kCloseTimeout{100};      // chosen: at most this delay at a program's end
constexpr std::string_view kKeyGuid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";  // RFC 6455 §1.3

/// Types of frames (RFC 6455 §5.2).
enum Opcode : unsigned char { kContinuation = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

tl::unexpected<Error> io_error(std::string message) { return fail(ErrorCode::kIo, std::move(message)); }

/// Sec-WebSocket-Accept by which a server answers `key` (RFC 6455 §4.2.2).
std::string accept_of(const std::string& key) {
  boost::uuids::detail::sha1 hash;
  hash.process_bytes(key.data(), key.size());
  hash.process_bytes(kKeyGuid.data(), kKeyGuid.size());
  unsigned int words[5];
  hash.get_digest(words);
  std::string bytes(20, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<char>(words[i / 4] >> (24 - 8 * (i % 4)));
  return base64(bytes);
}

/// Value of the header `name`, in any case, from the head of an answer; empty when absent.
std::string_view header(std::string_view head, std::string_view name) {
  for (std::size_t line = head.find("\r\n"); line != std::string_view::npos;
       line = head.find("\r\n", line + 2)) {
    const std::string_view rest = head.substr(line + 2, head.find("\r\n", line + 2) - line - 2);
    const std::size_t colon = rest.find(':');
    if (colon == std::string_view::npos || lower(rest.substr(0, colon)) != lower(name)) continue;
    const std::size_t first = rest.find_first_not_of(' ', colon + 1);
    return first == std::string_view::npos ? std::string_view{} : rest.substr(first);
  }
  return {};
}

/// A connected, non-blocking TCP socket. Each call returns by its time `end`, except that the name look-up in
/// connect() takes the time that the system gives it.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int handle) : handle_{handle} {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  Socket(Socket&& other) noexcept : handle_{std::exchange(other.handle_, -1)} {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Socket() {
    if (handle_ >= 0) ::close(handle_);
  }

  /// Connects to the first address of the host that answers.
  static Result<Socket> connect(const Url& url, Clock::time_point end) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int status = ::getaddrinfo(url.host.c_str(), std::to_string(url.port).c_str(), &hints, &found);
    if (status != 0) return io_error(fmt::format("{}: {}", url.host, ::gai_strerror(status)));
    std::string why = "no address";
    for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
      Socket socket(::socket(entry->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
      why = socket.connect_to(*entry, end);
      if (!why.empty()) continue;
      ::freeaddrinfo(found);
      return socket;
    }
    ::freeaddrinfo(found);
    return io_error(fmt::format("{}:{}: {}", url.host, url.port, why));
  }

  /// Sends all bytes.
  Result<void> send(std::string_view bytes, Clock::time_point end) {
    while (!bytes.empty()) {
      const ssize_t count = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count > 0) {
        bytes.remove_prefix(static_cast<std::size_t>(count));
      } else if (errno != EAGAIN && errno != EINTR) {
        return io_error(fmt::format("connection lost: {}", std::strerror(errno)));
      } else if (!wait(POLLOUT, end)) {
        return io_error("the server does not read");
      }
    }
    return {};
  }

  /// Appends the bytes that arrive to `buffer`; false if none came until `end`.
  Result<bool> receive(std::string& buffer, Clock::time_point end) {
    std::array<char, 16384> chunk;
    for (;;) {
      const ssize_t count = ::recv(handle_, chunk.data(), chunk.size(), 0);
      if (count > 0) {
        buffer.append(chunk.data(), static_cast<std::size_t>(count));
        return true;
      }
      if (count == 0) return io_error("the server ended the connection");
      if (errno != EAGAIN && errno != EINTR)
        return io_error(fmt::format("connection lost: {}", std::strerror(errno)));
      if (!wait(POLLIN, end)) return false;
    }
  }

 private:
  /// Connects to one address. The reason of a failure, empty after success.
  std::string connect_to(const addrinfo& address, Clock::time_point end) {
    if (handle_ < 0) return std::strerror(errno);
    const int on = 1;
    ::setsockopt(handle_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    if (::connect(handle_, address.ai_addr, address.ai_addrlen) == 0) return {};
    if (errno != EINPROGRESS) return std::strerror(errno);
    if (!wait(POLLOUT, end)) return "no answer";
    int error = 0;
    socklen_t size = sizeof(error);
    ::getsockopt(handle_, SOL_SOCKET, SO_ERROR, &error, &size);
    return error == 0 ? std::string{} : std::strerror(error);
  }

  /// Waits until the socket has one of the `events` of poll(2); false if none came until `end`.
  [[nodiscard]] bool wait(short events, Clock::time_point end) const {
    constexpr std::int64_t kLongest = 3'600'000;  // [ms] chosen: an hour, far within an int
    const auto left = std::chrono::ceil<Milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    pollfd entry{handle_, events, 0};
    const int ready = ::poll(&entry, 1, static_cast<int>(std::min<std::int64_t>(left, kLongest)));
    return ready < 0 && errno == EINTR ? wait(events, end) : ready > 0;
  }

  int handle_ = -1;  ///< descriptor; -1: none
};

/// Client over a Socket: the upgrade, and frames of RFC 6455.
class WebSocketClient final : public Client {
 public:
  explicit WebSocketClient(Socket socket) : socket_{std::move(socket)} {}

  ~WebSocketClient() override {
    constexpr std::string_view kNormalClosure{"\x03\xe8", 2};  // code 1000 of RFC 6455 §7.4.1
    if (is_open_) static_cast<void>(send_frame(kClose, kNormalClosure, kCloseTimeout));
  }

  /// Sends the upgrade request and checks the answer (RFC 6455 §4.1).
  Result<void> shake_hands(const Url& url, Clock::time_point end) {
    std::string nonce(16, '\0');
    for (char& byte : nonce) byte = static_cast<char>(random_());
    const std::string key = base64(nonce);
    const bool is_v6 = url.host.find(':') != std::string::npos;
    const std::string request = fmt::format(
        "GET {} HTTP/1.1\r\nUser-Agent: websocket-sharp/1.0\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Host: {}:{}\r\nSec-WebSocket-Key: {}\r\nSec-WebSocket-Version: 13\r\n\r\n",
        url.target, is_v6 ? "[" + url.host + "]" : url.host, url.port, key);
    if (auto sent = socket_.send(request, end); !sent) return sent;
    std::size_t length = std::string::npos;
    while ((length = input_.find("\r\n\r\n")) == std::string::npos) {
      if (input_.size() > kMaxHeader) return io_error("the server's answer to the upgrade is too long");
      const Result<bool> received = socket_.receive(input_, end);
      if (!received) return fail(received.error());
      if (!*received) return io_error("the server does not answer the upgrade request");
    }
    const std::string head = input_.substr(0, length + 2);
    input_.erase(0, length + 4);
    return check(head, key);
  }

  Result<void> send_text(const std::string& text) override { return send_frame(kText, text, kSendTimeout); }

  Result<std::optional<std::string>> receive(Milliseconds timeout) override {
    const Clock::time_point end = Clock::now() + timeout;
    for (;;) {
      if (!is_open_) return io_error("the connection has been closed");
      const Result<Taken> taken = take_frame();
      if (!taken) {
        is_open_ = false;
        return fail(taken.error());
      }
      if (*taken == Taken::kMessage) return std::exchange(message_, {});
      if (*taken == Taken::kFrame) continue;
      const Result<bool> received = socket_.receive(input_, end);
      if (!received) {
        is_open_ = false;
        return fail(received.error());
      }
      if (!*received) return std::optional<std::string>{};
    }
  }

 private:
  /// Outcome of take_frame(): no whole frame in input_, a frame, or the frame that ends a message.
  enum class Taken { kNothing, kFrame, kMessage };

  /// Opens the connection if `head` is the right answer to an upgrade with `key`.
  Result<void> check(const std::string& head, const std::string& key) {
    const std::string status = head.substr(0, head.find("\r\n"));
    if (!status.starts_with("HTTP/1.1 101")) {
      const std::size_t last = input_.find_last_not_of("\r\n");
      return io_error(fmt::format(
          "the server refused: {}{}", status,
          last == std::string::npos ? "" : ": " + input_.substr(0, std::min(last + 1, kMaxReason))));
    }
    if (lower(header(head, "Upgrade")) != "websocket")
      return io_error("the server's 101 has no 'Upgrade: websocket'");
    if (header(head, "Sec-WebSocket-Accept") != accept_of(key))
      return io_error("the server's Sec-WebSocket-Accept is wrong");
    if (!header(head, "Sec-WebSocket-Extensions").empty())
      return io_error("the server uses an extension nobody offered");
    is_open_ = true;
    return {};
  }

  /// Sends one frame, masked by random bytes (RFC 6455 §5.2).
  Result<void> send_frame(Opcode opcode, std::string_view payload, Milliseconds timeout) {
    if (!is_open_) return io_error("the connection has been closed");
    std::string frame;
    frame += static_cast<char>(0x80 | opcode);
    const std::size_t size = payload.size();
    if (size < 126) {
      frame += static_cast<char>(0x80 | size);
    } else {
      const int bytes = size < 65536 ? 2 : 8;
      frame += static_cast<char>(0x80 | (bytes == 2 ? 126 : 127));
      for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>((size >> (8 * i)) & 0xff);
    }
    std::array<char, 4> mask{};
    for (char& byte : mask) byte = static_cast<char>(random_());
    frame.append(mask.data(), mask.size());
    for (std::size_t i = 0; i < size; ++i) frame += static_cast<char>(payload[i] ^ mask[i % 4]);
    Result<void> sent = socket_.send(frame, Clock::now() + timeout);
    if (!sent) is_open_ = false;
    return sent;
  }

  /// Takes one frame from input_ if all its bytes have arrived: adds data to message_, answers a ping.
  Result<Taken> take_frame() {
    const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(input_[i]); };
    if (input_.size() < 2) return Taken::kNothing;
    const bool is_last = (byte(0) & 0x80U) != 0;
    const unsigned opcode = byte(0) & 0x0fU;
    if ((byte(0) & 0x70U) != 0) return io_error("the server sent a frame with reserved bits");
    if ((byte(1) & 0x80U) != 0) return io_error("the server sent a masked frame");
    std::uint64_t size = byte(1) & 0x7fU;
    const std::size_t extra = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (input_.size() < 2 + extra) return Taken::kNothing;
    if (extra > 0) size = 0;
    for (std::size_t i = 0; i < extra; ++i) size = (size << 8U) | byte(2 + i);
    if (size > kMaxMessage || message_.size() + size > kMaxMessage)
      return io_error("the server sent more than 1 MiB at once");
    if (input_.size() < 2 + extra + size) return Taken::kNothing;
    const std::string payload = input_.substr(2 + extra, static_cast<std::size_t>(size));
    input_.erase(0, 2 + extra + static_cast<std::size_t>(size));
    switch (opcode) {
      case kPing:
        static_cast<void>(send_frame(kPong, payload, kPongTimeout));
        return Taken::kFrame;
      case kPong:
        return Taken::kFrame;
      case kClose:
        return io_error(closing_words(payload));
      case kContinuation:
      case kText:
      case kBinary:
        message_ += payload;
        return is_last ? Taken::kMessage : Taken::kFrame;
      default:
        return io_error(fmt::format("the server sent a frame of unknown type {}", opcode));
    }
  }

  /// Sentence with the code and reason of a close frame.
  static std::string closing_words(const std::string& payload) {
    if (payload.size() < 2) return "the server closed the connection";
    const int code = static_cast<unsigned char>(payload[0]) * 256 + static_cast<unsigned char>(payload[1]);
    return fmt::format("the server closed the connection: {} {}", code, payload.substr(2));
  }

  Socket socket_;
  std::string input_;    ///< received bytes that are not part of a taken frame
  std::string message_;  ///< data of the frames of a message that has not ended
  bool is_open_ = false;
  std::random_device random_;
};

}  // namespace

Result<Url> parse_url(const std::string& text) {
  const auto refuse = [&](const char* expected) {
    return fail(ErrorCode::kInvalidArgument, fmt::format("url: got '{}', expected {}", text, expected));
  };
  constexpr std::string_view kScheme = "ws://";
  if (!text.starts_with(kScheme)) return refuse("ws://host:port/path");
  if (text.find_first_of(" \r\n\t") != std::string::npos) return refuse("no blanks");
  const std::size_t slash = text.find('/', kScheme.size());
  const std::string authority = text.substr(kScheme.size(), slash - kScheme.size());
  Url url;
  if (slash != std::string::npos) url.target = text.substr(slash);
  const std::size_t bracket = authority.rfind(']');
  const std::size_t colon = authority.find(':', bracket == std::string::npos ? 0 : bracket);
  url.host = authority.substr(0, colon);
  if (bracket != std::string::npos) url.host = authority.substr(1, bracket - 1);
  if (url.host.empty()) return refuse("a host");
  if (colon != std::string::npos) {
    const std::uint64_t port = count_in(std::string_view(authority).substr(colon + 1)).value_or(0);
    if (port == 0 || port > 65535) return refuse("a port in [1, 65535]");
    url.port = static_cast<std::uint16_t>(port);
  }
  return url;
}

Result<std::unique_ptr<Client>> Client::connect(const std::string& url, std::chrono::milliseconds timeout) {
  const Clock::time_point end = Clock::now() + timeout;
  const Result<Url> parsed = parse_url(url);
  if (!parsed) return fail(parsed.error());
  Result<Socket> socket = Socket::connect(*parsed, end);
  if (!socket) return fail(socket.error());
  auto client = std::make_unique<WebSocketClient>(std::move(*socket));
  if (auto shaken = client->shake_hands(*parsed, end); !shaken) return fail(shaken.error());
  return client;
}

}  // namespace chicane::net
