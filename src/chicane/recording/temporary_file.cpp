// SPDX-License-Identifier: MIT
#include "chicane/recording/temporary_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>

namespace chicane::recording {

TemporaryFile::TemporaryFile(std::string_view extension) {
  static std::atomic<unsigned> number{0};
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) folder = ".";
  path_ = (folder / fmt::format("chicane-{}-{}{}", ::getpid(), number++, extension)).string();
  std::filesystem::remove(path_, error);  // of a process of that number that was killed
}

TemporaryFile::~TemporaryFile() {
  std::error_code error;
  std::filesystem::remove(path_, error);
}

}  // namespace chicane::recording
