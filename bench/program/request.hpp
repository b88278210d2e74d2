// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::bench {

/// What `chicane bench` asks for. Its help and defaults are in apps/chicane/options.cpp.
struct Request {
  int instances = 100;                    ///< of each family
  std::vector<int> horizons{10, 20, 50};  ///< intervals, each 2 to kLongestHorizon
  bool is_json = false;
};

/// Reads `--instances N --horizons N,... --json`, as `chicane bench` passes them on; all may be left out.
/// kInvalid: "--horizons: got X, expected Y".
[[nodiscard]] Result<Request> parse_request(const std::vector<std::string>& words);

}  // namespace chicane::bench
