// SPDX-License-Identifier: MIT
#include "chicane/net/token.hpp"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace chicane::net {

Result<std::string> make_token() {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  static_assert(kLetters.size() == 64);  // 6 bits each
  std::array<unsigned char, 32> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return fail(ErrorCode::kIo, std::string("token: no random bytes: ") + std::strerror(errno));
  std::string token;
  for (const unsigned char byte : bytes) token += kLetters[byte & 63U];
  return token;
}

bool is_token(std::string_view given, std::string_view token) noexcept {
  if (token.empty() || given.size() != token.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i)
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token[i]);
  return difference == 0;
}

}  // namespace chicane::net
