// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "chicane/base/result.hpp"
#include "chicane/ros/dds.hpp"

namespace chicane::ros {

/// Readers and writers of a node, one after the other: a topic without a name is left out, and after the
/// first that cannot be made no other is tried.
class Endpoints {
 public:
  /// `at` has to outlive it.
  explicit Endpoints(Participant& at) : at_{at} {}

  void read(std::unique_ptr<Reader>& to, const std::string& topic, std::string_view type, Qos qos) {
    if (!topic.empty() && made_) take(to, at_.reader(topic, std::string(type), qos));
  }
  void send(std::unique_ptr<Writer>& to, const std::string& topic, std::string_view type, Qos qos) {
    if (!topic.empty() && made_) take(to, at_.writer(topic, std::string(type), qos));
  }
  /// The error of the one that could not be made.
  [[nodiscard]] const Result<void>& made() const noexcept { return made_; }

 private:
  template <class Endpoint>
  void take(std::unique_ptr<Endpoint>& to, Result<std::unique_ptr<Endpoint>> endpoint) {
    if (endpoint)
      to = std::move(*endpoint);
    else
      made_ = fail(endpoint.error());
  }

  Participant& at_;
  Result<void> made_;
};

}  // namespace chicane::ros
