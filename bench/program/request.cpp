// SPDX-License-Identifier: MIT
#include "program/request.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {
namespace {

constexpr int kMostInstances = 100000;

Result<int> number_of(std::string_view option, std::string_view text, int low, int high) {
  const std::optional<std::uint64_t> number = count_in(text);
  if (!number || *number < static_cast<std::uint64_t>(low) || *number > static_cast<std::uint64_t>(high))
    return fail(refusal(option, text, fmt::format("{} to {}", low, high)));
  return static_cast<int>(*number);
}

Result<std::vector<int>> numbers_of(std::string_view text) {
  std::vector<int> numbers;
  for (const std::string_view word : protocol::split(text, ',')) {
    const Result<int> number = number_of("--horizons", word, 2, kLongestHorizon);
    if (!number) return fail(number.error());
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace

Result<Request> parse_request(const std::vector<std::string>& words) {
  Request request;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& option = words[i];
    if (option == "--json") {
      request.is_json = true;
      continue;
    }
    const bool is_known = option == "--instances" || option == "--horizons";
    if (!is_known || i + 1 == words.size()) {
      return fail(
          ErrorCode::kInvalidArgument,
          fmt::format("got {}, expected --instances N, --horizons N,... or --json (see `chicane bench "
                      "--help`)",
                      option));
    }
    const std::string& value = words[++i];
    if (option == "--instances") {
      const Result<int> number = number_of(option, value, 1, kMostInstances);
      if (!number) return fail(number.error());
      request.instances = *number;
    } else {
      Result<std::vector<int>> horizons = numbers_of(value);
      if (!horizons) return fail(horizons.error());
      request.horizons = std::move(*horizons);
    }
  }
  return request;
}

}  // namespace chicane::bench
