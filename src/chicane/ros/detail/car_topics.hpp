// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "chicane/ros/dds.hpp"
#include "chicane/ros/node_options.hpp"
#include "chicane/ros/partner_watch.hpp"

namespace chicane::ros {

/// The topics of the controller that need a partner: odometry, drive, then what `node` asks for.
[[nodiscard]] std::vector<WantedPartner> wanted_partners(const NodeOptions& node);

/// The controller's ends of the topics; null where their names are empty.
struct CarTopics {
  std::unique_ptr<Reader> odom{}, imu{}, path{}, kept_path{}, initial_pose{}, stop{};
  std::unique_ptr<Reader> transforms{}, fixed_transforms{};  ///< /tf, /tf_static
  std::unique_ptr<Reader> clock{};                           ///< null where time is not simulated
  std::unique_ptr<Writer> drive{}, autoware{}, stop_plan{};

  [[nodiscard]] static Result<CarTopics> create(Participant& at, const NodeOptions& node);
  /// Readers and writers with a partner, in the order of wanted_partners().
  [[nodiscard]] std::vector<int> matched() const;
};

}  // namespace chicane::ros
