// SPDX-License-Identifier: MIT
// Writing of files as a whole. Every failure is kIo with one sentence: "FILE: cannot be written: REASON".
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"

namespace chicane {

/// Replaces a file as a whole: writes a new file in the same folder, which finish() renames. The old file is
/// there until then, and stays when anything fails. Links, owner and permissions of the old file are kept.
/// Pipes, devices, and files in a folder that takes no new file are written directly.
class FileWriter {
 public:
  /// `mode`: permissions of a new file before the umask; 0666: all users may read and write.
  explicit FileWriter(std::string path, unsigned mode = 0666);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// Appends to the new file. Does nothing after a failure, which check() and finish() return.
  void write(std::string_view bytes);
  /// Fails with the first failure so far, kIo with its reason.
  [[nodiscard]] Result<void> check() const;
  /// Flushes to the disk and renames. Fails with kIo; the old file stays then.
  [[nodiscard]] Result<void> finish();

 private:
  /// Stores errno in fault_ if a system call failed and none failed before.
  void require(bool is_done);
  void close();

  std::string path_;     ///< file as the caller named it
  std::string target_;   ///< `path_` with its symbolic links resolved
  std::string part_;     ///< new file that becomes the target; empty: the target is written directly
  int descriptor_ = -1;  ///< open file; -1: none
  int fault_ = 0;        ///< errno of the first failure; 0: none
};

/// Replaces the file's content by a FileWriter. Fails with kIo; the file is as before then.
[[nodiscard]] Result<void> write_file(const std::string& path, std::string_view bytes, unsigned mode = 0666);

/// Checks before a long computation that its result can be written. Changes nothing. An empty name stands for
/// no file, and passes. Fails with kIo.
[[nodiscard]] Result<void> check_writable(const std::string& path);

/// Writes all bytes to an open file. False on failure, with the reason in errno.
[[nodiscard]] bool write_all(int descriptor, std::string_view bytes);

}  // namespace chicane
