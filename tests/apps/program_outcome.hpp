// SPDX-License-Identifier: MIT
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include "support/chicane_test.hpp"

/// The program as a user meets it: words in, text and exit codes out.
namespace chicane::test {

inline std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// A file of the current test alone.
inline fs::path file_of_test(const std::string& kind) {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  return fs::path(::testing::TempDir()) / ("chicane_" + test + "_" + kind + "_" + std::to_string(::getpid()));
}

/// Runs words of a shell in the root of the source tree.
inline Outcome shell(const std::string& words) {
  const fs::path errors = file_of_test("errors");
  const std::string command =
      "cd '" CHICANE_SOURCE_DIR "' && { " + words + "; } 2> '" + errors.string() + "'";
  Outcome outcome;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.out.append(buffer.data(), count);
  }
  const int status = ::pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.err = read(errors);
  fs::remove(errors);
  return outcome;
}

/// The program's words for a shell that runs it in the background or under `timeout`.
inline const std::string kProgram = std::string("'") + CHICANE_PROGRAM + "' ";

inline Outcome chicane_program(const std::string& arguments) { return shell(kProgram + arguments); }

/// Runs the program and interrupts it, as Ctrl-C does, when it has said `words`.
inline Outcome interrupted_program(const std::string& arguments, const std::string& words) {
  const std::string said = "'" + file_of_test("said").string() + "'";
  return shell(kProgram + arguments + " 2> " + said + " & program=$!; while kill -0 $program && ! grep -q '" +
               words + "' " + said +
               "; do sleep 0.05; done; kill -INT $program; wait $program; code=$?; cat " + said +
               " >&2; rm " + said + "; exit $code");
}

}  // namespace chicane::test
