// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace chicane::run {

/// Cache of expensive results in files of one folder, each under a name made of all its inputs
/// (docs/decisions/0033-plans-are-cached-on-disk.md). A failure of the disk costs time, never a run.
///
/// Several processes and threads may use one folder: a file is written beside its place and renamed, so that
/// it is there whole or not at all. A file whose length or checksum is wrong is ignored, with one line.
class DiskCache {
 public:
  static constexpr std::uint64_t kMostBytes = 64U << 20U;
  static constexpr std::size_t kMostFiles = 1000;

  /// `say`: lines for the user; may be empty. Creates the folder when the first result is kept.
  explicit DiskCache(std::string folder, std::function<void(std::string_view)> say = {},
                     std::uint64_t most_bytes = kMostBytes)
      : folder_{std::move(folder)}, say_{std::move(say)}, most_bytes_{most_bytes} {}

  /// $XDG_CACHE_HOME/chicane, else ~/.cache/chicane; empty where neither is an absolute path.
  [[nodiscard]] static std::string default_folder();

  /// The result of that name (hexadecimal digits); none: not there, or damaged.
  [[nodiscard]] std::optional<std::string> find(std::string_view name) const;
  /// Writes it, then removes the files unused for longest until no more than `most_bytes` and
  /// kMostFiles are left.
  void keep(std::string_view name, std::string_view bytes) const;
  /// One line on a result whose file is whole, but whose content makes no sense.
  void report_damage(std::string_view name) const;

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

 private:
  [[nodiscard]] std::string path_of(std::string_view name) const;
  void make_room() const;

  std::string folder_;
  std::function<void(std::string_view)> say_;
  std::uint64_t most_bytes_;
};

}  // namespace chicane::run
