// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>

namespace chicane::runtime {

/// A path in the folder for temporary files where nothing is; what is made there is removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view extension) {
    static std::atomic<unsigned> number{0};
    std::error_code error;
    std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error) folder = ".";
    path_ = (folder / ("chicane-" + std::to_string(::getpid()) + "-" + std::to_string(number++))).string();
    path_ += extension;
    std::filesystem::remove(path_, error);  // of a process of that number that was killed
  }
  ~TemporaryFile() {
    std::error_code error;
    if (!path_.empty()) std::filesystem::remove(path_, error);
  }
  TemporaryFile(TemporaryFile&& other) noexcept : path_{std::move(other.path_)} { other.path_.clear(); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace chicane::runtime
