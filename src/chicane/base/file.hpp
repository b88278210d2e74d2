// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

/// Files that are written. Whatever goes wrong is said in one sentence: "FILE: cannot be written: REASON".
namespace chicane {

/// Replaces a file as a whole: writes beside it and renames. Until finish() the old file is there, and it
/// stays when anything fails. Links, owner and permissions of the old file are kept. Pipes and devices are
/// written through, and so is a file whose folder takes no new one.
class FileWriter {
 public:
  /// `mode`: permissions of a new file, less the umask.
  explicit FileWriter(std::string path, unsigned mode = 0666);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// After an error nothing: check() and finish() say it.
  void write(std::string_view bytes);
  /// kIo with the reason of the first error.
  [[nodiscard]] Result<void> check() const;
  /// Flushes to the disk and renames. kIo, and then the old file stays.
  [[nodiscard]] Result<void> finish();

 private:
  void note(bool is_done);
  void close();

  std::string path_;
  std::string target_;  ///< the file itself, behind links
  std::string part_;    ///< beside the target; empty when it is written through
  int descriptor_ = -1;
  int fault_ = 0;  ///< errno
};

/// Replaces the file's content, or changes nothing. kIo.
[[nodiscard]] Result<void> write_file(const std::string& path, std::string_view bytes, unsigned mode = 0666);

/// Before what takes long: that write_file() can begin. Changes nothing; an empty name is no file. kIo.
[[nodiscard]] Result<void> check_writable(const std::string& path);

/// Whether all bytes were written; errno says why not.
[[nodiscard]] bool write_all(int descriptor, std::string_view bytes);

}  // namespace chicane
