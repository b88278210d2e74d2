// SPDX-License-Identifier: MIT
// Body of main, interrupts and status line; and the commands that other programs run, so that no other
// command waits for their libraries.
#include "program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <variant>

#include "chicane/base/instruction_set.hpp"
#include "chicane/protocol/data_folders.hpp"
#include "chicane/run/plan_cache.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

namespace fs = std::filesystem;

// Times between two lines of StatusLine, on a terminal and in a file; chosen.
constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::seconds kLogPeriod{10};

/// Keeps plans and limits in the user's cache folder, unless --no-cache is given.
void use_cache(const Options& options) {
  const std::string folder = options.uses_cache ? run::DiskCache::default_folder() : "";
  if (folder.empty()) return;
  run::use_plan_cache(std::make_shared<const run::DiskCache>(folder, [](std::string_view line) {
    std::fprintf(stderr, "%.*s\n", static_cast<int>(line.size()), line.data());
  }));
}

/// Present path of a shipped file. In version 0.2 these files were in the root of a clone; they are in data
/// and studies now.
std::string present_path(const std::string& word) {
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

/// Reads the command line and runs its command.
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

// Globals, because a signal handler has access to nothing else.
std::atomic<std::atomic<bool>*> interrupt_flag{nullptr};  // flag of catch_interrupts()
std::atomic<std::int64_t> first_ns{0};                    // time of the first signal [ns]; 0: none yet
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free &&
              std::atomic<std::atomic<bool>*>::is_always_lock_free);

/// Time since the start of the machine [ns]. A signal handler may call it, unlike the clocks of C++.
std::int64_t monotonic_ns() {
  std::timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Signal handler of catch_interrupts().
void interrupt(int signal) {
  const std::int64_t now = monotonic_ns();
  std::int64_t first = 0;
  if (first_ns.compare_exchange_strong(first, now)) {
    if (std::atomic<bool>* flag = interrupt_flag.load()) *flag = true;
  } else if (now - first > std::chrono::nanoseconds(kOneInterrupt).count()) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // delivered after this handler returns
  }
}

/// Folders of the other programs, relative to the folder of this one: for a build folder, bin and
/// libexec/chicane of an installation.
constexpr const char* kPlaces[] = {"", "../libexec/chicane", "../../bin"};

/// Whether a file can be started.
bool is_program(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

/// Replaces this process, or prints why that fails.
ExitCode become_or_say_why(const std::string& program, std::vector<std::string> words) {
  fmt::print(stderr, "{}\n", become(program, std::move(words)));
  return kEnvironment;
}

/// Prints how to build a program that is missing.
ExitCode say_how_to_build(const std::string& command, std::string_view program, std::string_view meaning,
                          std::string_view target) {
  fmt::print(stderr,
             "chicane {0}: {1}, the program {2}, is not built (looked in {4}).\n"
             "In a clone `./run.sh {0}` builds it; in a build folder `cmake --build . --target {3}`.\n",
             command, program, meaning, target, own_folder());
  return kEnvironment;
}

}  // namespace

ExitCode report(const Error& error) {
  print_sentence(stderr, error.message);
  return error.code == ErrorCode::kIo ? kEnvironment : kUsage;
}

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

int program_of(const char* command, int count, const char* const* words,
               ExitCode (*run)(const Options&)) noexcept {
  std::vector<const char*> all{"chicane", command};
  all.insert(all.end(), words + (count > 0 ? 1 : 0), words + count);
  return program(static_cast<int>(all.size()), all.data(), run);
}

void let_interrupts_end() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

void catch_interrupts(std::atomic<bool>& flag) {
  interrupt_flag = &flag;
  run::stop_planning_by(flag);
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
}

std::string own_folder() {
  const std::string program = protocol::data_origins().program;
  return program.empty() ? "" : fs::path(program).parent_path().string();
}

std::string other_program(const std::string& name, bool is_on_path) {
  const fs::path folder = own_folder();
  for (const char* place : kPlaces) {
    const fs::path file = folder / place / name;
    if (!folder.empty() && is_program(file)) return file.lexically_normal().string();
  }
  const char* path = is_on_path ? std::getenv("PATH") : nullptr;
  for (std::string_view left = path == nullptr ? "" : path; !left.empty();) {
    const std::size_t end = std::min(left.find(':'), left.size());
    const fs::path file = fs::path(left.substr(0, end)) / name;
    if (file.is_absolute() && is_program(file)) return file.string();
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return "";
}

std::string become(const std::string& program, std::vector<std::string> words) {
  words.insert(words.begin(), program);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  return program + " cannot be started: " + std::strerror(errno);
}

StatusLine::StatusLine() : is_terminal_{isatty(STDERR_FILENO) == 1} {
  next_ = begin_ + (is_terminal_ ? std::chrono::seconds{0} : kLogPeriod);
}

double StatusLine::seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

void StatusLine::show(std::string_view line) {
  next_ = Clock::now() + (is_terminal_ ? Clock::duration(kTerminalPeriod) : kLogPeriod);
  has_line_ = is_terminal_;
  if (is_terminal_)
    fmt::print(stderr, "\r{}\x1b[K", line);  // clears the rest of the old line
  else
    fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

void StatusLine::end() {
  if (has_line_.exchange(false)) fmt::print(stderr, "\n");
}

void StatusLine::clear() {
  if (has_line_.exchange(false)) fmt::print(stderr, "\r\x1b[K");
}

ExitCode ros(const Options& options) {
  const std::string program = other_program("chicane-ros", true);
  if (!program.empty()) return become_or_say_why(program, options.words);
  fmt::print(stderr,
             "chicane ros: the program chicane-ros is not there: install it (apt install "
             "./chicane-ros_*.deb, in a clone ./run.sh ros)\n");
  return kUsage;
}

ExitCode bench(const Options& options) {
  const std::string program = other_program("chicane-bench", false);
  if (!program.empty()) return become_or_say_why(program, options.words);
  return say_how_to_build("bench", "chicane-bench", "that measures", "chicane_bench");
}

ExitCode in_lab(const Options& options) {
  const std::string program = other_program("chicane-lab", false);
  if (program.empty())
    return say_how_to_build(options.command, "chicane-lab", "of many runs, logs and reports", "chicane_lab");
  std::vector<std::string> words{options.command};
  words.insert(words.end(), options.words.begin(), options.words.end());
  return become_or_say_why(program, std::move(words));
}

}  // namespace chicane::apps
