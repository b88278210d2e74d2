// SPDX-License-Identifier: MIT
// Writing of files: a new file is written beside its place and renamed at the end, so that no reader sees
// half a file. Descriptors, and files in folders that take no new file, are written directly.
#include "chicane/base/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

namespace chicane {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_be_written(const std::string& path, int reason) {
  return fail(ErrorCode::kIo, path + ": cannot be written: " + std::strerror(reason));
}

/// Whether `path` names an open descriptor. Its file belongs to the program that opened it: is appended to,
/// never replaced.
bool is_descriptor(std::string_view path) {
  constexpr std::array<std::string_view, 3> kFolders{"/dev/std", "/dev/fd/", "/proc/"};
  return std::any_of(kFolders.begin(), kFolders.end(), [&](auto folder) { return path.starts_with(folder); });
}

}  // namespace

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

FileWriter::FileWriter(std::string path, unsigned mode) : path_{std::move(path)}, target_{path_} {
  std::error_code error;
  struct stat old {};
  const bool exists = ::stat(path_.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) fault_ = EISDIR;
  require(!exists || ::access(path_.c_str(), W_OK) == 0);
  const bool is_plain = exists ? S_ISREG(old.st_mode) : !fs::is_symlink(path_, error);
  if (fault_ != 0 || !is_plain || is_descriptor(path_)) return;

  if (exists) target_ = fs::canonical(path_, error).string();
  const fs::path folder = fs::path(target_).parent_path();
  for (int number = 0; descriptor_ < 0 && (number == 0 || errno == EEXIST); ++number) {
    part_ = (folder / (".chicane-" + std::to_string(::getpid()) + "-" + std::to_string(number) + ".part"))
                .string();
    descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  }

  if (descriptor_ < 0) {
    part_.clear();
    // Folders that take no new file: write() opens the old one.
    require(exists && (errno == EACCES || errno == EPERM || errno == EROFS));
  } else if (exists) {
    static_cast<void>(!::fchown(descriptor_, old.st_uid, old.st_gid));  // only root may: failure ignored
    require(::fchmod(descriptor_, old.st_mode & 07777U) == 0);
  }
}

FileWriter::~FileWriter() {
  close();
  if (!part_.empty()) ::unlink(part_.c_str());
}

void FileWriter::require(bool is_done) {
  if (!is_done && fault_ == 0) fault_ = errno;
}

void FileWriter::close() {
  if (descriptor_ >= 0) require(::close(std::exchange(descriptor_, -1)) == 0);
}

void FileWriter::write(std::string_view bytes) {
  if (fault_ != 0) return;
  if (descriptor_ < 0) {
    const int flags = is_descriptor(path_) ? O_APPEND : O_CREAT | O_TRUNC;
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
  }
  require(descriptor_ >= 0 && write_all(descriptor_, bytes));
}

Result<void> FileWriter::check() const {
  return fault_ == 0 ? Result<void>{} : cannot_be_written(path_, fault_);
}

Result<void> FileWriter::finish() {
  if (!part_.empty() && fault_ == 0) require(::fsync(descriptor_) == 0);
  close();
  if (!part_.empty() && fault_ == 0) {
    require(std::rename(part_.c_str(), target_.c_str()) == 0);
    if (fault_ == 0) part_.clear();
  }
  return check();
}

Result<void> write_file(const std::string& path, std::string_view bytes, unsigned mode) {
  FileWriter file(path, mode);
  file.write(bytes);
  return file.finish();
}

Result<void> check_writable(const std::string& path) {
  return path.empty() ? Result<void>{} : FileWriter(path).check();
}

}  // namespace chicane
