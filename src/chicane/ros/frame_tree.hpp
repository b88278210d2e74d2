// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>

#include "chicane/model/state.hpp"
#include "chicane/protocol/car_messages.hpp"

namespace chicane::ros {

/// The pose of what has `inner` in a frame, seen from where that frame has `frame`.
[[nodiscard]] model::Pose composed(const model::Pose& frame, const model::Pose& inner) noexcept;

/// Frames and where they lie in the plane, as /tf and /tf_static tell it: the newest of each. One thread.
class FrameTree {
 public:
  static constexpr std::size_t kCapacity = 1000;  ///< frames; transforms of further ones are left out
  static constexpr int kDeepest = 32;             ///< frames in a chain

  /// Leaves out numbers that are not finite.
  void put(const protocol::TransformMessage& transform);
  /// Where `frame` lies in `in`; none where their chains of parents do not meet.
  [[nodiscard]] std::optional<model::Pose> find(const std::string& in, const std::string& frame) const;

 private:
  struct Link {
    std::string parent{};
    model::Pose pose{};  ///< in the parent
  };
  [[nodiscard]] std::map<std::string, model::Pose> seen_from_parents(const std::string& frame) const;

  std::map<std::string, Link> links_;  ///< by the child
};

}  // namespace chicane::ros
