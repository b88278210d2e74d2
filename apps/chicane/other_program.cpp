// SPDX-License-Identifier: MIT
#include "other_program.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "chicane/protocol/data_folders.hpp"

namespace chicane::apps {
namespace {

namespace fs = std::filesystem;

/// Seen from the folder of this program: a build folder, bin and libexec/chicane of an installation.
constexpr const char* kPlaces[] = {"", "../libexec/chicane", "../../bin"};

bool is_program(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

}  // namespace

std::string own_folder() {
  const std::string program = protocol::data_origins().program;
  return program.empty() ? "" : fs::path(program).parent_path().string();
}

std::string other_program(const std::string& name, bool is_on_path) {
  const fs::path folder = own_folder();
  for (const char* place : kPlaces) {
    const fs::path file = folder / place / name;
    if (!folder.empty() && is_program(file)) return file.lexically_normal().string();
  }
  const char* path = is_on_path ? std::getenv("PATH") : nullptr;
  for (std::string_view left = path == nullptr ? "" : path; !left.empty();) {
    const std::size_t end = std::min(left.find(':'), left.size());
    const fs::path file = fs::path(left.substr(0, end)) / name;
    if (file.is_absolute() && is_program(file)) return file.string();
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return "";
}

std::string become(const std::string& program, std::vector<std::string> words) {
  words.insert(words.begin(), program);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  return program + " cannot be started: " + std::strerror(errno);
}

}  // namespace chicane::apps
