// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>

/// Bounds of server.cpp that nobody sets.
namespace chicane::net {

inline constexpr int kSendBuffer =
    32 * 1024;  // a reader that stalls holds this much kernel memory, not megabytes
inline constexpr std::chrono::seconds kAnswerTimeout{30};  // for one piece of an answer on a slow line
inline constexpr std::chrono::seconds kLingerTimeout{1};   // so that a refusal is read before the socket goes
inline constexpr std::chrono::milliseconds kAcceptPause{100};  // when descriptors are used up, for example
inline constexpr std::size_t kKeptBuffer = 4096;               // between two messages [byte]
inline constexpr std::size_t kMostReserved = 8;                // connections that viewers leave to others

}  // namespace chicane::net
