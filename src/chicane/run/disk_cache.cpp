// SPDX-License-Identifier: MIT
// Cache of results in files: names, checksums, and removal of the oldest.
#include "chicane/run/disk_cache.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "chicane/base/file.hpp"
#include "chicane/base/random.hpp"

namespace chicane::run {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "chicane cache 1\n";  // the number: of this layout
constexpr std::string_view kExtension = ".cache";
constexpr std::string_view kUnfinished = ".part";  // suffix of base/file.hpp
constexpr std::size_t kHeader = kMagic.size() + 2 * sizeof(std::uint64_t);
constexpr auto kAbandoned = std::chrono::hours(1);  // a file that a killed process left

std::uint64_t checksum(std::string_view bytes) {
  Fnv hash;
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    hash.add(word);
  }
  return hash.value();
}

void append(std::string& to, std::uint64_t value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
  to.append(bytes.data(), bytes.size());
}

std::uint64_t number_at(std::string_view bytes, std::size_t at) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

bool is_whole(std::string_view file) {
  return file.size() >= kHeader && file.starts_with(kMagic) &&
         number_at(file, kMagic.size()) == file.size() - kHeader &&
         number_at(file, kMagic.size() + sizeof(std::uint64_t)) == checksum(file.substr(kHeader));
}

}  // namespace

std::string DiskCache::default_folder() {
  // An empty or relative path counts as unset, by the XDG base directory specification.
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/')
    return std::string(cache) + "/chicane";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::string(home) + "/.cache/chicane";
  return {};
}

std::string DiskCache::path_of(std::string_view name) const {
  return folder_ + "/" + std::string(name) + std::string(kExtension);
}

std::optional<std::string> DiskCache::find(std::string_view name) const {
  const std::string path = path_of(name);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return {};
  std::string file{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!is_whole(file)) {
    report_damage(name);
    return {};
  }
  ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);  // used now
  file.erase(0, kHeader);
  return file;
}

void DiskCache::report_damage(std::string_view name) const {
  if (say_) say_("cache: " + path_of(name) + " is damaged and ignored");
}

void DiskCache::keep(std::string_view name, std::string_view bytes) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return;
  std::string file(kMagic);
  append(file, bytes.size());
  append(file, checksum(bytes));
  file += bytes;
  if (write_file(path_of(name), file, 0600)) make_room();
}

void DiskCache::make_room() const {
  struct File {
    fs::path path;
    fs::file_time_type used;
    std::uint64_t size;
  };
  std::vector<File> files;
  std::uint64_t all = 0;
  std::error_code error;
  // Other processes may remove files meanwhile: what cannot be asked is passed over.
  for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;
    const fs::path& path = at->path();
    const fs::file_time_type used = fs::last_write_time(path, gone);
    const std::uint64_t size = gone ? 0 : fs::file_size(path, gone);
    if (gone) continue;
    if (path.extension() == kUnfinished && fs::file_time_type::clock::now() - used > kAbandoned)
      fs::remove(path, gone);
    if (path.extension() != kExtension) continue;
    files.push_back({path, used, size});
    all += size;
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  std::size_t left = files.size();
  for (const File& file : files) {
    if (all <= most_bytes_ && left <= kMostFiles) return;
    std::error_code gone;
    fs::remove(file.path, gone);
    all -= file.size;
    --left;
  }
}

}  // namespace chicane::run
