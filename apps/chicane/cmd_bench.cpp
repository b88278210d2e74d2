// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "commands.hpp"

namespace chicane::apps {
namespace {

namespace fs = std::filesystem;

/// Where chicane-bench may be, seen from the folder of this program: beside it in a build folder, in libexec
/// of an installation.
constexpr const char* kPlaces[] = {"chicane-bench", "../libexec/chicane/chicane-bench"};

fs::path own_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

/// Empty when there is none.
std::string bench_program() {
  const fs::path folder = own_folder();
  std::error_code error;
  for (const char* place : kPlaces) {
    if (fs::exists(folder / place, error)) return (folder / place).lexically_normal().string();
  }
  return "";
}

/// The options in full, as bench/program/request.hpp reads them.
std::vector<std::string> words_of(const Options& options) {
  std::vector<std::string> words{"--instances", std::to_string(options.instances), "--horizons",
                                 fmt::format("{}", fmt::join(options.horizons, ","))};
  if (!options.reference_folder.empty()) words.insert(words.end(), {"--reference", options.reference_folder});
  if (options.is_json) words.emplace_back("--json");
  return words;
}

}  // namespace

ExitCode bench(const Options& options) {
  const std::string program = bench_program();
  if (program.empty()) {
    fmt::print(stderr,
               "chicane bench: chicane-bench, the program that measures, is not built (looked in {}).\n"
               "In a clone `./run.sh bench` builds it; in a build folder `cmake --build . --target "
               "chicane_bench`.\n",
               own_folder().string());
    return kEnvironment;
  }
  std::vector<std::string> words = words_of(options);
  words.insert(words.begin(), program);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  fmt::print(stderr, "{} cannot be started: {}\n", program, std::strerror(errno));
  return kEnvironment;
}

}  // namespace chicane::apps
