// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "chicane/run/roads.hpp"

namespace chicane::run {

/// Calls work(i, roads) once for each i in [0, count), on `jobs` threads, this one among them; i rises, and
/// no two calls share a `roads`. A work that returns false ends it all: those that have begun are finished.
void for_each_run(std::uint64_t count, int jobs, const std::function<bool(std::uint64_t, Roads&)>& work);

/// Threads for `wanted` jobs; 0: as many as there are processors.
[[nodiscard]] int threads_for(int wanted);

}  // namespace chicane::run
