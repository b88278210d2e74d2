// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace chicane::net {

/// Whether an end of a connection may send this status in a close frame: those that RFC 6455 §7.4.1 and its
/// registry define for that, libraries' (3000 to 3999) and private ones (4000 to 4999).
[[nodiscard]] bool may_be_sent(unsigned status) noexcept;

/// The status that a close frame's payload has to be answered with because it breaks RFC 6455: 1002 for a
/// status that nobody may send, 1007 for a reason that is not UTF-8. Nothing for others.
[[nodiscard]] std::optional<std::uint16_t> answer_to_close(std::string_view payload) noexcept;

/// Follows the frames of a WebSocket client through the bytes of its connection, as far as its close frame.
class CloseWatch {
 public:
  /// Takes the next bytes. The status of answer_to_close(), once, when the close frame ends in them.
  [[nodiscard]] std::optional<std::uint16_t> take(std::string_view bytes);

 private:
  void take_header(char byte);
  [[nodiscard]] bool has_header() const;

  std::string header_;           ///< header so far of the frame that begins, at most 14 bytes
  std::string mask_;             ///< mask of the frame's payload; empty: none
  std::uint64_t remaining_ = 0;  ///< rest of the frame's payload [byte]
  bool is_close_ = false;        ///< the frame is a close frame
  std::string payload_;          ///< payload of the close frame so far, unmasked
};

}  // namespace chicane::net
