// SPDX-License-Identifier: MIT
#include "chicane/net/detail/close_watch.hpp"

#include <algorithm>

#include "chicane/base/utf8.hpp"

namespace chicane::net {
namespace {

constexpr std::uint16_t kProtocolError = 1002, kBadPayload = 1007;
constexpr unsigned kCloseFrame = 8;
constexpr std::uint64_t kMostOfControl = 125;  // [byte] payload of a control frame

unsigned number(char byte) { return static_cast<unsigned char>(byte); }

/// Bytes of the extended length that follow the first two.
std::size_t extension(char second) {
  const unsigned length = number(second) & 0x7fU;
  return length == 126 ? 2 : length == 127 ? 8 : 0;
}

}  // namespace

bool may_be_sent(unsigned status) noexcept {
  const bool is_defined = (status >= 1000 && status <= 1003) || (status >= 1007 && status <= 1013);
  return is_defined || (status >= 3000 && status <= 4999);
}

std::optional<std::uint16_t> answer_to_close(std::string_view payload) noexcept {
  if (payload.empty()) return std::nullopt;
  if (payload.size() == 1) return kProtocolError;
  if (!may_be_sent(number(payload[0]) << 8U | number(payload[1]))) return kProtocolError;
  if (!is_utf8(payload.substr(2))) return kBadPayload;
  return std::nullopt;
}

bool CloseWatch::has_header() const {
  if (header_.size() < 2) return false;
  const bool is_masked = (number(header_[1]) & 0x80U) != 0;
  return header_.size() == 2 + extension(header_[1]) + (is_masked ? 4 : 0);
}

void CloseWatch::take_header(char byte) {
  header_ += byte;
  if (!has_header()) return;

  const std::size_t extended = extension(header_[1]);
  remaining_ = extended == 0 ? number(header_[1]) & 0x7fU : 0;
  for (std::size_t i = 0; i < extended; ++i) remaining_ = remaining_ << 8U | number(header_[2 + i]);
  mask_ = header_.substr(2 + extended);
  is_close_ = (number(header_[0]) & 0x0fU) == kCloseFrame && remaining_ <= kMostOfControl;
  header_.clear();
}

std::optional<std::uint16_t> CloseWatch::take(std::string_view bytes) {
  while (!bytes.empty()) {
    if (remaining_ == 0) {
      take_header(bytes.front());
      bytes.remove_prefix(1);
      continue;
    }
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(remaining_, bytes.size()));
    if (is_close_) {
      for (const char byte : bytes.substr(0, count))
        payload_ += mask_.empty() ? byte : static_cast<char>(byte ^ mask_[payload_.size() % 4]);
    }
    remaining_ -= count;
    bytes.remove_prefix(count);
    if (is_close_ && remaining_ == 0) return answer_to_close(payload_);
  }
  return std::nullopt;
}

}  // namespace chicane::net
