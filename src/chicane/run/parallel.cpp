// SPDX-License-Identifier: MIT
#include "chicane/run/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace chicane::run {

void for_each_run(std::uint64_t count, int jobs, const std::function<bool(std::uint64_t, Roads&)>& work) {
  std::atomic<std::uint64_t> next{0};
  std::atomic<bool> goes_on{true};
  const auto run = [&] {
    Roads roads;
    for (std::uint64_t i = next++; i < count && goes_on; i = next++)
      if (!work(i, roads)) goes_on = false;
  };
  std::vector<std::thread> others;
  for (int j = 1; j < jobs; ++j) others.emplace_back(run);
  run();
  for (std::thread& other : others) other.join();
}

int threads_for(int wanted) {
  return wanted > 0 ? wanted : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace chicane::run
