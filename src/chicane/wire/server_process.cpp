// SPDX-License-Identifier: MIT
#include "chicane/wire/server_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace chicane::wire {
namespace {

constexpr std::chrono::seconds kRestartAfter{1};
constexpr unsigned kPatience = 1;  // of the guard, with a group that was asked to end [s]

[[noreturn]] void run_shell(const char* command, const sigset_t& no_signals) {
  ::sigprocmask(SIG_SETMASK, &no_signals, nullptr);
  const int nothing = ::open("/dev/null", O_RDWR);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);  // the original's controllers print every message
  ::execl("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr));
  ::_exit(127);
}

/// Ends as the shell ended.
[[noreturn]] void end_like(int status, const sigset_t& no_signals) {
  if (WIFSIGNALED(status)) {
    ::sigprocmask(SIG_SETMASK, &no_signals, nullptr);
    static_cast<void>(::signal(WTERMSIG(status), SIG_DFL));
    static_cast<void>(::raise(WTERMSIG(status)));
  }
  ::_exit(WEXITSTATUS(status));
}

/// The head of the group: waits for the shell; asked to end, or left alone, it ends the whole group. Forked
/// from a program with several threads, so it only makes system calls.
[[noreturn]] void guard(const char* command, pid_t parent) {
  ::setpgid(0, 0);
  sigset_t awaited, no_signals;
  ::sigemptyset(&no_signals);
  ::sigemptyset(&awaited);
  for (const int signal : {SIGCHLD, SIGTERM, SIGALRM}) ::sigaddset(&awaited, signal);
  ::sigprocmask(SIG_SETMASK, &awaited, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);     // whom the shell leaves behind is ours to wait for
  if (::getppid() != parent) ::_exit(0);  // it died before we listened
  const pid_t shell = ::fork();
  if (shell == 0) run_shell(command, no_signals);
  for (bool is_ending = false;;) {
    int signal = 0;
    if (::sigwait(&awaited, &signal) != 0) continue;
    if (signal == SIGALRM) ::kill(0, SIGKILL);
    if (signal == SIGTERM && !is_ending) {
      is_ending = true;
      ::kill(0, SIGTERM);
      ::alarm(kPatience);
    }
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(-1, &status, WNOHANG)) > 0) {
      if (ended == shell && !is_ending) end_like(status, no_signals);
    }
    if (ended < 0) ::_exit(0);  // none is left
  }
}

}  // namespace

ServerProcess::~ServerProcess() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGTERM);
  ::waitpid(pid_, nullptr, 0);  // within the guard's time limit
}

void ServerProcess::keep_running(std::chrono::steady_clock::time_point now) {
  if (command_.empty()) return;
  if (pid_ > 0) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) return;
    pid_ = -1;
    log_.say(WIFSIGNALED(status) ? fmt::format("the controller was ended by signal {}", WTERMSIG(status))
                                 : fmt::format("the controller ended with status {}", WEXITSTATUS(status)));
  }
  if (starts_ > 0 && now - started_ < kRestartAfter) return;
  start();
  started_ = now;
  ++starts_;
}

void ServerProcess::start() {
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) guard(command_.c_str(), parent);
}

}  // namespace chicane::wire
