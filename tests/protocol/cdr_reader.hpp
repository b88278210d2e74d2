// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/protocol/car_messages.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {

/// XCDR1, little endian, written from the specification (OMG DDSI-RTPS 2.3, chapter 10; CORBA 3.4 part
/// 2, 9.3): each primitive is aligned to its size, counted from the end of the four-byte header.
class CdrReader {
 public:
  explicit CdrReader(std::string_view bytes) : bytes_{bytes} {
    EXPECT_EQ(bytes.substr(0, 4), std::string_view("\0\1\0\0", 4));
  }
  template <class T>
  T get() {
    at_ += (sizeof(T) - (at_ - 4) % sizeof(T)) % sizeof(T);
    T value{};
    if (at_ + sizeof(T) > bytes_.size()) {
      ADD_FAILURE() << "message ends at " << bytes_.size() << ", field at " << at_;
      return value;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const auto size = get<std::uint32_t>();
    std::string value{bytes_.substr(at_, size - 1)};
    EXPECT_EQ(bytes_.at(at_ + size - 1), '\0');
    at_ += size;
    return value;
  }
  double number() { return get<double>(); }
  double seconds() {
    const auto whole = get<std::int32_t>();
    return whole + 1e-9 * get<std::uint32_t>();
  }
  void skip_numbers(int count) {
    for (int i = 0; i < count; ++i) EXPECT_EQ(number(), 0.0);
  }
  [[nodiscard]] bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 4;
};

/// Each message that ends too early is refused.
template <class Message>
void expect_refused_when_cut(const std::string& bytes) {
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(protocol::decode<Message>(std::string_view(bytes).substr(0, size))) << size;
}

}  // namespace chicane::test
