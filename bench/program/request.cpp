// SPDX-License-Identifier: MIT
#include "program/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "problems/reference.hpp"

namespace chicane::bench {
namespace {

constexpr int kMostInstances = 100000;

std::optional<int> number_in(std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  return is_number && value >= low && value <= high ? std::optional(value) : std::nullopt;
}

tl::unexpected<Error> refuse(std::string_view option, std::string_view text, int low, int high) {
  return fail(ErrorCode::kInvalidArgument,
              fmt::format("{}: got {}, expected {} to {}", option, text, low, high));
}

Result<std::vector<int>> numbers_of(std::string_view text) {
  std::vector<int> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string_view word = text.substr(begin, comma - begin);
    const std::optional<int> number = number_in(word, 2, kLongestHorizon);
    if (!number) return refuse("--horizons", word, 2, kLongestHorizon);
    numbers.push_back(*number);
    begin = comma + 1;
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
    const bool is_known = option == "--instances" || option == "--horizons" || option == "--reference";
    if (!is_known || i + 1 == words.size()) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("got {}, expected --instances N, --horizons N,..., --reference FOLDER or "
                              "--json (see `chicane bench --help`)",
                              option));
    }
    const std::string& value = words[++i];
    if (option == "--instances") {
      const std::optional<int> number = number_in(value, 1, kMostInstances);
      if (!number) return refuse(option, value, 1, kMostInstances);
      request.instances = *number;
    } else if (option == "--horizons") {
      Result<std::vector<int>> horizons = numbers_of(value);
      if (!horizons) return fail(horizons.error());
      request.horizons = std::move(*horizons);
    } else {
      request.reference_folder = value;
    }
  }
  return request;
}

}  // namespace chicane::bench
