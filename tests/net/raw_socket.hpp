// SPDX-License-Identifier: MIT
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace chicane::test {

/// A bare TCP connection to a port of this machine, for tests that send bytes no well-behaved library would.
class RawSocket {
 public:
  explicit RawSocket(std::uint16_t port, int receive_buffer = 0)
      : RawSocket(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0)
      ::setsockopt(handle_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_connected_ = ::connect(handle_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  /// Takes over an accepted handle.
  static RawSocket of(int handle) { return RawSocket(handle); }
  RawSocket(RawSocket&& other) noexcept : handle_{other.handle_}, is_connected_{other.is_connected_} {
    other.handle_ = -1;
  }
  RawSocket(const RawSocket&) = delete;
  RawSocket& operator=(const RawSocket&) = delete;
  RawSocket& operator=(RawSocket&&) = delete;
  ~RawSocket() { close(); }

  [[nodiscard]] bool is_connected() const { return is_connected_; }
  void close() {
    if (handle_ >= 0) ::close(handle_);
    handle_ = -1;
  }

  void send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count <= 0) return;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }

  /// Says that nothing more will be sent.
  void end() const { ::shutdown(handle_, SHUT_WR); }

  /// Leaves nothing behind when it is closed: thousands a second would use up the ports of this machine.
  void forget_when_closed() const {
    const ::linger none{1, 0};
    ::setsockopt(handle_, SOL_SOCKET, SO_LINGER, &none, sizeof(none));
  }

  /// Reads until `input_` contains `mark` and takes everything up to and including it; what there is when the
  /// peer ends or nothing comes for `patience`.
  std::string until(std::string_view mark, std::chrono::milliseconds patience = std::chrono::seconds{10}) {
    std::size_t found = 0;
    while ((found = input_.find(mark)) == std::string::npos) {
      if (!fill(patience)) return take(input_.size());
    }
    return take(found + mark.size());
  }

  /// Everything until the peer ends the connection.
  std::string rest(std::chrono::milliseconds patience = std::chrono::seconds{10}) {
    while (fill(patience)) {
    }
    return take(input_.size());
  }

  /// One frame from a server, header and payload; nullopt when the peer ends or is silent.
  struct Frame {
    int opcode = 0;
    std::string payload;
  };
  std::optional<Frame> frame(std::chrono::milliseconds patience = std::chrono::seconds{10}) {
    const auto need = [&](std::size_t size) {
      while (input_.size() < size) {
        if (!fill(patience)) return false;
      }
      return true;
    };
    if (!need(2)) return std::nullopt;
    const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(input_[i]); };
    std::size_t size = byte(1) & 0x7fU;
    std::size_t start = 2;
    if (size >= 126) {
      const std::size_t extra = size == 126 ? 2 : 8;
      if (!need(2 + extra)) return std::nullopt;
      size = 0;
      for (std::size_t i = 0; i < extra; ++i) size = (size << 8U) | byte(2 + i);
      start += extra;
    }
    if (!need(start + size)) return std::nullopt;
    Frame frame{byte(0) & 0x0f, input_.substr(start, size)};
    input_.erase(0, start + size);
    return frame;
  }

  /// A masked client frame of any opcode.
  static std::string masked(std::string_view payload, int opcode = 1) {
    std::string frame(1, static_cast<char>(0x80 | opcode));
    if (payload.size() < 126) {
      frame += static_cast<char>(0x80U | payload.size());
    } else {
      const int bytes = payload.size() < 65536 ? 2 : 8;
      frame += static_cast<char>(bytes == 2 ? 0xfe : 0xff);
      for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>((payload.size() >> (8 * i)) & 0xffU);
    }
    constexpr std::array<unsigned char, 4> kMask{0x12, 0x34, 0x56, 0x78};
    for (const unsigned char byte : kMask) frame += static_cast<char>(byte);
    for (std::size_t i = 0; i < payload.size(); ++i) frame += static_cast<char>(payload[i] ^ kMask[i % 4]);
    return frame;
  }

 private:
  explicit RawSocket(int handle) : handle_{handle}, is_connected_{handle >= 0} {}

  std::string take(std::size_t size) {
    std::string taken = input_.substr(0, size);
    input_.erase(0, size);
    return taken;
  }

  bool fill(std::chrono::milliseconds patience) {
    pollfd entry{handle_, POLLIN, 0};
    if (::poll(&entry, 1, static_cast<int>(patience.count())) <= 0) return false;
    std::array<char, 4096> chunk;
    const ssize_t count = ::recv(handle_, chunk.data(), chunk.size(), 0);
    if (count <= 0) return false;
    input_.append(chunk.data(), static_cast<std::size_t>(count));
    return true;
  }

  int handle_ = -1;
  bool is_connected_ = false;
  std::string input_;
};

/// The upgrade request of the original simulator, byte for byte (udacity/self-driving-car-sim v1.45,
/// websocket-sharp's HandshakeRequest.cs), with the sample key of RFC 6455 §1.3.
inline std::string unity_handshake(std::uint16_t port) {
  return "GET /socket.io/?EIO=4&transport=websocket HTTP/1.1\r\nUser-Agent: websocket-sharp/1.0\r\nUpgrade: "
         "websocket\r\n"
         "Connection: Upgrade\r\nHost: 127.0.0.1:" +
         std::to_string(port) +
         "\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
}

}  // namespace chicane::test
