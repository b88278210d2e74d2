// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace chicane::protocol {

/// Reads one message of a stranger: CDR (XCDR1) of either byte order with its four-byte header. What lies
/// beyond the end reads as zero, and ok() is false from then on.
class CdrSource {
 public:
  explicit CdrSource(std::string_view bytes) : bytes_{bytes} {
    ok_ = bytes.size() >= kHeader && bytes[0] == '\0' && (bytes[1] == '\0' || bytes[1] == '\1');
    swaps_ = ok_ && bytes[1] == '\0';
  }

  /// Everything so far was there.
  [[nodiscard]] bool ok() const { return ok_; }

  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t past = (at_ - kHeader) % sizeof(T);
    skip(past == 0 ? 0 : sizeof(T) - past);
    std::array<char, sizeof(T)> raw{};
    if (!take(raw.data(), sizeof(T))) return T{};
    if (swaps_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  double number() { return get<double>(); }
  /// A boolean, of which any byte but zero is true.
  bool flag() { return get<std::uint8_t>() != 0; }

  /// A string, without the zero at its end.
  std::string_view text() {
    const auto size = get<std::uint32_t>();
    if (!ok_ || size > bytes_.size() - at_) return fail();
    const std::string_view value = bytes_.substr(at_, size);
    at_ += size;
    if (value.empty()) return value;  // some writers send no zero for an empty string
    if (value.back() != '\0') return fail();
    return value.substr(0, value.size() - 1);
  }

  /// The number of elements of a sequence that have at least `smallest` bytes each; 0 where so many cannot
  /// follow.
  std::uint32_t count(std::size_t smallest) {
    const auto value = get<std::uint32_t>();
    if (ok_ && value <= (bytes_.size() - at_) / smallest) return value;
    ok_ = ok_ && value == 0;
    return 0;
  }

  /// builtin_interfaces/Time in nanoseconds.
  std::int64_t stamp() {
    const auto seconds = get<std::int32_t>();
    return std::int64_t{seconds} * 1'000'000'000 + get<std::uint32_t>();
  }

 private:
  static constexpr std::size_t kHeader = 4;

  std::string_view fail() {
    ok_ = false;
    return {};
  }
  void skip(std::size_t size) {
    if (ok_ && size <= bytes_.size() - at_) {
      at_ += size;
    } else {
      ok_ = false;
    }
  }
  bool take(char* to, std::size_t size) {
    if (!ok_ || size > bytes_.size() - at_) return ok_ = false;
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
    return true;
  }

  std::string_view bytes_;
  std::size_t at_ = kHeader;
  bool ok_ = false;
  bool swaps_ = false;
};

}  // namespace chicane::protocol
