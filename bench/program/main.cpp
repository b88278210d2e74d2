// SPDX-License-Identifier: MIT
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "chicane/base/instruction_set.hpp"
#include "program/measure.hpp"
#ifdef CHICANE_HAVE_IPOPT
#include "references/ipopt_reference.hpp"
#endif
#ifdef CHICANE_HAVE_PEERS
#include "references/peer_references.hpp"
#endif

namespace {

using namespace chicane;

// Exit codes of `chicane`.
constexpr int kSuccess = 0;
constexpr int kUsage = 2;
constexpr int kEnvironment = 3;

std::atomic<bool> stop{false};  // a signal handler can reach nothing but globals
static_assert(std::atomic<bool>::is_always_lock_free);

int report(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return error.code == ErrorCode::kIo ? kEnvironment : kUsage;
}

bench::References all_references() {
  bench::References references;
#ifdef CHICANE_HAVE_IPOPT
  bench::add_ipopt(references);
#else
  std::fputs("Built without Ipopt (Debian: coinor-libipopt-dev, then build again).\n", stderr);
#endif
#ifdef CHICANE_HAVE_PEERS
  bench::add_peers(references);
#else
  std::fputs("Built without fatrop and HPIPM (bench/README.md).\n", stderr);
#endif
  return references;
}

int run(const std::vector<std::string>& words) {
  if (const auto set = environment_instruction_set(); !set) return report(set.error());
  const Result<bench::Request> request = bench::parse_request(words);
  if (!request) return report(request.error());
  // Ctrl-C and SIGTERM end it with the results so far: no row takes long.
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop = true; });
  bench::References references = all_references();
  const Result<bench::BenchReport> result = bench::measure(*request, references, stop);
  if (!result) return report(result.error());
  const std::string text = request->is_json ? to_json(*result) : to_markdown(*result);
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return kSuccess;
  std::fprintf(stderr, "chicane bench: the results could not be written: %s\n", std::strerror(errno));
  return kEnvironment;
}

}  // namespace

/// What `chicane bench` starts; takes the options it passes on (program/request.hpp).
int main(int count, char** words) {
  try {
    return run({words + 1, words + count});
  } catch (const std::exception& e) {
    std::fprintf(stderr, "chicane bench: %s\n", e.what());
  } catch (...) {
    std::fputs("chicane bench: unknown error\n", stderr);
  }
  return kEnvironment;
}
