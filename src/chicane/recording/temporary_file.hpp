// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace chicane::recording {

/// A path in the folder for temporary files where nothing is; what is made there is removed at the end.
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
