// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/foxglove_codec.hpp"

/// Requests and replies of the parameter services that every ROS 2 node has (rcl_interfaces/srv), as
/// rmw_cyclonedds sends them: in front of the content stands which client asked, and its number of the
/// request.
namespace chicane::protocol {

/// What a reply repeats of its request.
struct ServiceCall {
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
};

/// rcl_interfaces/srv/GetParameters and DescribeParameters, and ListParameters, whose prefixes these are.
struct NamesRequest {
  ServiceCall call{};
  std::vector<std::string> names{};
};
[[nodiscard]] std::string encode_names_request(const NamesRequest& request);
/// Bytes that are no such request give none; what follows the names is left unread.
[[nodiscard]] std::optional<NamesRequest> decode_names_request(std::string_view bytes);

/// rcl_interfaces/srv/SetParameters. Numbers of any kind are double; arrays are read as not set.
struct SetRequest {
  ServiceCall call{};
  std::vector<foxglove::Parameter> parameters{};
};
[[nodiscard]] std::string encode_set_request(const SetRequest& request);
[[nodiscard]] std::optional<SetRequest> decode_set_request(std::string_view bytes);

/// The reply to SetParameters, for each parameter.
struct SetOutcome {
  bool is_successful = false;
  std::string reason{};  ///< why not, in a sentence
};
[[nodiscard]] std::string encode_set_reply(const ServiceCall& call, const std::vector<SetOutcome>& outcomes);
[[nodiscard]] std::optional<std::vector<SetOutcome>> decode_set_reply(std::string_view bytes);

/// The reply to ListParameters.
[[nodiscard]] std::string encode_list_reply(const ServiceCall& call, const std::vector<std::string>& names);
[[nodiscard]] std::optional<std::vector<std::string>> decode_list_reply(std::string_view bytes);
/// The reply to GetParameters: values in the order of the request; monostate: there is none of that name.
/// Tunables that are whole numbers go as integers.
[[nodiscard]] std::string encode_get_reply(const ServiceCall& call,
                                           const std::vector<foxglove::Parameter>& values);
[[nodiscard]] std::optional<std::vector<foxglove::ParameterValue>> decode_get_reply(std::string_view bytes);
/// The reply to DescribeParameters: type, meaning and range from the schema's table.
[[nodiscard]] std::string encode_describe_reply(const ServiceCall& call,
                                                const std::vector<foxglove::Parameter>& values);

}  // namespace chicane::protocol
