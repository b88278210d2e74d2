// SPDX-License-Identifier: MIT
#include "ros_trial.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/sweep/trial.hpp"
#include "chicane/wire/server_process.hpp"

namespace chicane::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{100};  // between looks at what the simulator has said

/// A folder for what the simulator says, gone with this.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "chicane-league-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n");
  if (end == std::string::npos) return "it has said nothing";
  const std::size_t begin = text.find_last_of("\r\n", end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

}  // namespace

Result<telemetry::RunSummary> drive_ros_program(const sweep::ExternalTrial& trial, int domain,
                                                const std::string& own, double patience,
                                                const std::atomic<bool>& stop) {
  const Folder folder;
  if (folder.path().empty()) return fail(ErrorCode::kIo, "no folder for temporary files");
  const std::string out = (folder.path() / "out").string(), err = (folder.path() / "err").string();
  const std::string done = (folder.path() / "done").string();
  std::string simulator = fmt::format("{} ros --simulate --json --domain {}", own, domain);
  for (const auto& [key, text] : trial.settings)
    simulator += fmt::format(" --set {}", sweep::shell_word(key + "=" + text));
  simulator += fmt::format(" > {} 2> {}; : > {}", sweep::shell_word(out), sweep::shell_word(err),
                           sweep::shell_word(done));

  wire::SparseLog log({});
  wire::ServerProcess simulating(simulator, log);
  wire::ServerProcess driving(sweep::filled(trial, domain, own), log);
  const Clock::time_point began = Clock::now();
  simulating.keep_running(began);
  driving.keep_running(began);
  bool has_command = false;
  while (!stop) {
    std::this_thread::sleep_for(kLook);
    const std::string said = protocol::read_file(err).value_or("");
    if (fs::exists(done)) {
      auto run = protocol::read_run(protocol::read_file(out).value_or(""));
      return run ? std::move(run) : fail(ErrorCode::kIo, "the simulator has no result: " + last_line(said));
    }
    has_command = has_command || said.find("first command on") != std::string::npos;
    if (!has_command && std::chrono::duration<double>(Clock::now() - began).count() > patience)
      return fail(ErrorCode::kIo, fmt::format("the program sends no command in DDS domain {}", domain));
  }
  return fail(ErrorCode::kIo, "stopped");
}

}  // namespace chicane::apps
