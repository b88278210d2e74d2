// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/base/result.hpp"

namespace chicane::recording {

/// The file metadata.yaml beside a recording, which makes its folder a bag of rosbag2.
[[nodiscard]] std::string bag_metadata_path(const std::string& recording);

/// Fails where the folder is another recording's bag already: its metadata.yaml names another file.
[[nodiscard]] Result<void> can_be_bag(const std::string& recording);

/// Writes metadata.yaml beside a recording, of version 5, which rosbag2 reads from ROS 2 Humble on: the
/// topics in CDR with their messages counted. Chicane's own topics are among them; players leave out types
/// that they do not know. Reads the whole recording. kIo as read_mcap() fails, and where the file cannot be
/// written.
[[nodiscard]] Result<void> write_bag_metadata(const std::string& recording);

}  // namespace chicane::recording
