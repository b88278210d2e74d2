// SPDX-License-Identifier: MIT
#include "program.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "chicane/base/instruction_set.hpp"
#include "chicane/run/plan_cache.hpp"

namespace chicane::apps {
namespace {

/// Plans and limits are kept where the user's caches are, unless --no-cache is given.
void use_cache(const Options& options) {
  const std::string folder = options.uses_cache ? run::DiskCache::default_folder() : "";
  if (folder.empty()) return;
  run::use_plan_cache(std::make_shared<const run::DiskCache>(folder, [](std::string_view line) {
    std::fprintf(stderr, "%.*s\n", static_cast<int>(line.size()), line.data());
  }));
}

/// The file that a path of version 0.2 names: shipped files lay in the root of a clone, and lie in data and
/// studies.
std::string present_path(const std::string& word) {
  namespace fs = std::filesystem;
  const fs::path old = word.substr(0, word.find('/'));
  std::error_code ignored;
  if (old.empty() || old == word || fs::exists(old, ignored)) return word;

  for (const char* folder : {"data", "studies"}) {
    if (!fs::exists(folder / old, ignored)) continue;
    std::fprintf(stderr, "chicane: %s lies in %s/ now: reading %s/%s\n", word.c_str(), folder, folder,
                 word.c_str());
    return std::string(folder) + "/" + word;
  }
  return word;
}

ExitCode parse_and_run(int count, const char* const* given, ExitCode (*run)(const Options&)) {
  std::vector<std::string> present(given, given + count);
  std::vector<const char*> words;
  for (int i = 0; i < count; ++i) {
    if (i > 1) present[i] = present_path(present[i]);
    words.push_back(present[i].c_str());
  }
  const std::variant<Options, Done> parsed = parse_command_line(count, words.data());
  if (const Done* done = std::get_if<Done>(&parsed)) return done->code;
  if (const auto set = environment_instruction_set(); !set) {
    std::fprintf(stderr, "chicane: %s\n", set.error().message.c_str());
    return kUsage;
  }
  use_cache(std::get<Options>(parsed));
  const ExitCode code = run(std::get<Options>(parsed));
  if (std::fflush(stdout) == 0) return code;
  std::fprintf(stderr, "chicane: the results could not be written: %s\n", std::strerror(errno));
  return kEnvironment;
}

}  // namespace

int program(int count, const char* const* words, ExitCode (*run)(const Options&)) noexcept {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too long is a failed write
  try {
    return parse_and_run(count, words, run);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "chicane: %s\n", e.what());
  } catch (...) {
    std::fprintf(stderr, "chicane: unknown error\n");
  }
  return kEnvironment;
}

}  // namespace chicane::apps
