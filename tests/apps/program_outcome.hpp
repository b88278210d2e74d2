// SPDX-License-Identifier: MIT
#pragma once

#include <sys/wait.h>

#include "support/folder.hpp"

/// The program as a user meets it: words in, text and exit codes out.
namespace chicane::test {

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// Runs words of a shell in the root of the source tree.
inline Outcome shell(const std::string& words) {
  const Folder folder;
  const std::string command =
      "cd '" CHICANE_SOURCE_DIR "' && { " + words + "; } 2> '" + folder.path("errors") + "'";
  Outcome outcome;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.out.append(buffer.data(), count);
  const int status = ::pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.err = folder.content("errors");
  return outcome;
}

/// The program's words for a shell that runs it in the background or under `timeout`.
inline const std::string kProgram = std::string("'") + CHICANE_PROGRAM + "' ";

inline Outcome chicane_program(const std::string& arguments) { return shell(kProgram + arguments); }

/// Runs the program and interrupts it, as Ctrl-C does, when it has said `words`.
inline Outcome interrupted_program(const std::string& arguments, const std::string& words) {
  const Folder folder;
  const std::string said = "'" + folder.path("said") + "'";
  return shell(kProgram + arguments + " 2> " + said + " & program=$!; while kill -0 $program && ! grep -q '" +
               words + "' " + said +
               "; do sleep 0.05; done; kill -INT $program; wait $program; code=$?; cat " + said +
               " >&2; exit $code");
}

}  // namespace chicane::test
