// SPDX-License-Identifier: MIT
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <clocale>

#include "support/chicane_test.hpp"

namespace chicane::test {

/// Switches this process to a decimal comma (German) while it lives; makes the locale where the machine knows
/// it only by source. `is_set()` is false where the Debian package `locales` is missing.
class CommaLocale {
 public:
  CommaLocale() : before_{std::setlocale(LC_ALL, nullptr)}, is_set_{set() || (make() && set())} {}
  ~CommaLocale() { std::setlocale(LC_ALL, before_.c_str()); }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  [[nodiscard]] bool is_set() const noexcept { return is_set_; }

 private:
  static bool set() { return std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr; }
  static bool make() {
    const std::string folder = testing::TempDir() + "chicane_locales_" + std::to_string(::getpid());
    const std::string command =
        "mkdir -p " + folder + " && localedef -i de_DE -f UTF-8 " + folder + "/de_DE.UTF-8 2>/dev/null";
    if (std::system(command.c_str()) != 0) return false;
    ::setenv("LOCPATH", folder.c_str(), 1);
    return true;
  }

  std::string before_;
  bool is_set_;
};

}  // namespace chicane::test
