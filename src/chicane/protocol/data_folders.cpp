// SPDX-License-Identifier: MIT
#include "chicane/protocol/data_folders.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>

#ifdef __linux__
#include <dlfcn.h>
#include <sys/auxv.h>
#endif

// Defined by programs that were compiled with an installation, see data_folders.hpp; null in all others.
extern "C" {
[[gnu::weak]] extern const char chicane_installed_header[];
}

namespace chicane::protocol {
namespace {

namespace fs = std::filesystem;

/// The absolute path of a file that exists, with links resolved; empty for anything else.
std::string existing_file(const char* path) {
  std::error_code missing;
  const fs::path file = path == nullptr ? fs::path() : fs::canonical(path, missing);
  return missing ? "" : file.string();
}

std::string running_program() {
#ifdef __linux__
  if (const std::string file = existing_file("/proc/self/exe"); !file.empty()) return file;
  return existing_file(std::bit_cast<const char*>(::getauxval(AT_EXECFN)));  // the kernel's, as a number
#else
  return "";
#endif
}

/// Where the library is part of the program this is the name that the program was called by, which is a path
/// only if it has a slash.
std::string containing_object() {
#ifdef __linux__
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&data_folders), &info) != 0 && info.dli_fname != nullptr &&
      std::string_view(info.dli_fname).find('/') != std::string_view::npos)
    return existing_file(info.dli_fname);
#endif
  return "";
}

}  // namespace

DataOrigins data_origins() {
  DataOrigins origins;
  if (const char* folder = std::getenv("CHICANE_DATA_DIR"); folder != nullptr) origins.environment = folder;
  origins.program = running_program();
  origins.shared_object = containing_object();
  if (chicane_installed_header != nullptr) origins.header = chicane_installed_header;
  return origins;
}

std::vector<std::string> data_folders(const DataOrigins& origins, std::string_view kind) {
  std::vector<std::string> found;
  const auto add = [&](const fs::path& place) {
    std::error_code missing;
    const fs::path real = fs::canonical(place / kind, missing);
    const std::string folder = missing ? (place / kind).lexically_normal().string() : real.string();
    if (std::find(found.begin(), found.end(), folder) == found.end()) found.push_back(folder);
  };
  found.push_back((fs::path(".") / kind).string());
  if (!origins.environment.empty()) found.push_back((fs::path(origins.environment) / kind).string());
  for (const std::string& file : {origins.program, origins.shared_object}) {
    if (file.empty()) continue;
    const fs::path folder = fs::path(file).parent_path();
    add(folder / "share/chicane");
    add(folder / CHICANE_DATA_FROM_PROGRAM);
    add(folder / ".." / CHICANE_DATA_FROM_PROGRAM);
  }
  if (!origins.header.empty()) add(fs::path(origins.header).parent_path() / CHICANE_DATA_FROM_HEADER);
  add(CHICANE_INSTALL_DATA_DIR);
  add("/usr/share/chicane");
  return found;
}

}  // namespace chicane::protocol
