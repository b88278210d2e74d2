// SPDX-License-Identifier: MIT
// A million solves that ask nothing of the operating system: no memory, no lock, no system call.
#include <dlfcn.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <mutex>

#include "problems/described_problem.hpp"
#include "problems/families.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"

namespace {

std::atomic<std::int64_t> locks{0};

using Lock = int (*)(pthread_mutex_t*);

}  // namespace

/// Replaces the C library's own, which std::mutex calls: uncontended locks make no system call.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static const Lock real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  locks.fetch_add(1, std::memory_order_relaxed);
  return real(mutex);
}

namespace chicane {
namespace {

constexpr int kCapacity = 20;
constexpr std::int64_t kSolves = 1'000'000;

struct Account {
  std::int64_t solves = 0, unsolved = 0, allocations = 0, locks = 0;
};

/// In a process whose every system call but read, write and exit is deadly.
template <class Work>
bool in_a_silent_process(const Work& work, Account& account) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    const auto prepared = work();  // allocates what it needs
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) syscall(SYS_exit, 3);
    const Account result = prepared();
    const bool is_told = write(pipe_ends[1], &result, sizeof result) == sizeof result;
    syscall(SYS_exit, is_told ? 0 : 4);
  }
  close(pipe_ends[1]);
  const bool is_told = read(pipe_ends[0], &account, sizeof account) == sizeof account;
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return is_told && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

template <class Problem>
auto solve_often(std::int64_t count) {
  using Solver = solver::OcpSolver<Problem, kCapacity>;
  auto ocp = std::make_shared<Solver>();
  auto answer = std::make_shared<bench::DescribedTrajectory<kCapacity>>();
  auto family = std::make_shared<std::vector<bench::Instance<Problem, kCapacity>>>(
      bench::make_family<Problem, kCapacity>(bench::Start::kWarm, 10, 32, *ocp));
  for (auto& instance : bench::make_family<Problem, kCapacity>(bench::Start::kCold, 20, 4, *ocp))
    family->push_back(instance);
  return [=] {
    Account account;
    const std::int64_t locks_before = locks;
    const test::AllocationGuard guard;
    for (; account.solves < count; ++account.solves) {
      const auto& instance = (*family)[static_cast<std::size_t>(account.solves) % family->size()];
      answer->horizon = instance.guess.horizon;
      std::copy_n(instance.guess.u.begin(), instance.guess.horizon, answer->u.begin());
      const auto report = ocp->solve(instance.problem, instance.start, *answer);
      account.unsolved += report.status == solver::SolveStatus::kOptimal ? 0 : 1;
    }
    account.allocations = guard.count();
    account.locks = locks - locks_before;
    return account;
  };
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CHICANE_UNDER_SANITIZER true
#else
#define CHICANE_UNDER_SANITIZER false
#endif

TEST(Silence, TheTrapsWork) {
  const std::int64_t before = locks;
  std::mutex mutex;
  mutex.lock();
  mutex.unlock();
  EXPECT_EQ(locks, before + 1);
  if (CHICANE_UNDER_SANITIZER) GTEST_SKIP() << "sanitizers make system calls of their own";
  Account account;
  EXPECT_FALSE(in_a_silent_process([] { return [] { return Account{.solves = getppid()}; }; }, account));
  EXPECT_TRUE(in_a_silent_process([] { return [] { return Account{.solves = 7}; }; }, account));
  EXPECT_EQ(account.solves, 7);
}

TEST(Silence, AMillionSolvesWithoutMemoryLockOrSystemCall) {
  if (CHICANE_UNDER_SANITIZER) GTEST_SKIP() << "sanitizers make system calls of their own";
  Account account;
  ASSERT_TRUE(in_a_silent_process([] { return solve_often<bench::DescribedProblem>(kSolves); }, account))
      << "killed by a system call";
  EXPECT_EQ(account.solves, kSolves);
  EXPECT_EQ(account.unsolved, 0);
  EXPECT_EQ(account.allocations, 0);
  EXPECT_EQ(account.locks, 0);
}

TEST(Silence, SoDoSoftConstraints) {
  if (CHICANE_UNDER_SANITIZER) GTEST_SKIP() << "sanitizers make system calls of their own";
  Account account;
  ASSERT_TRUE(in_a_silent_process([] { return solve_often<bench::CorridorProblem>(kSolves / 50); }, account))
      << "killed by a system call";
  EXPECT_EQ(account.unsolved, 0);
  EXPECT_EQ(account.allocations, 0);
  EXPECT_EQ(account.locks, 0);
}

}  // namespace
}  // namespace chicane
