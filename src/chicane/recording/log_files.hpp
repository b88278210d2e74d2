// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/telemetry/mcap.hpp"

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

/// Copies a recording into a file with an index and no compression, as browsers read it: also one whose
/// writer was killed. `to` must not exist yet. How much there was to read; fails as read_mcap() and
/// McapWriter do.
[[nodiscard]] Result<telemetry::McapReport> indexed_copy(const std::string& from, const std::string& to);

/// Unused path in the folder for temporary files; whatever is made there is removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view extension);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace chicane::recording
