// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/detail/cdr_archive.hpp"
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
void call_fields(auto& archive, auto& message) { archive(message.call.client, message.call.sequence); }
/// rcl_interfaces/msg/ParameterValue, and ParameterDescriptor.
void value_fields(WritingArchive& archive, const foxglove::Parameter& parameter);
void value_fields(ReadingArchive& archive, foxglove::Parameter& parameter);
void descriptor_fields(WritingArchive& archive, const foxglove::Parameter& parameter);

inline constexpr std::size_t kMostParameters = 100'000;

/// rcl_interfaces/srv/GetParameters and DescribeParameters, and ListParameters, whose prefixes these are.
/// What follows the names is left unread.
struct NamesRequest {
  ServiceCall call{};
  std::vector<std::string> names{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive(message.names);
    archive.trailing(std::uint64_t{0});
  }
};

/// rcl_interfaces/srv/SetParameters. Numbers of any kind are double; arrays are read as not set.
struct SetRequest {
  ServiceCall call{};
  std::vector<foxglove::Parameter> parameters{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.parameters, 40, kMostParameters, [&](auto& each) {
      archive(each.name);
      value_fields(archive, each);
    });
  }
};

/// The reply to SetParameters, for each parameter.
struct SetOutcome {
  bool is_successful = false;
  std::string reason{};  ///< why not, in a sentence
};
struct SetReply {
  ServiceCall call{};
  std::vector<SetOutcome> outcomes{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.outcomes, 5, kMostParameters,
                 [&](auto& each) { archive(each.is_successful, each.reason); });
  }
};

/// The reply to ListParameters.
struct ListReply {
  ServiceCall call{};
  std::vector<std::string> names{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive(message.names);
    archive.trailing(std::uint32_t{0});  // no prefixes
  }
};

/// The reply to GetParameters: values in the order of the request, read without names; monostate: there is
/// none of that name. Tunables that are whole numbers go as integers.
struct GetReply {
  ServiceCall call{};
  std::vector<foxglove::Parameter> values{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.values, 32, kMostParameters, [&](auto& each) { value_fields(archive, each); });
  }
};

/// The reply to DescribeParameters: type, meaning and range from the schema's table. Is not read.
struct DescribeReply {
  ServiceCall call{};
  std::vector<foxglove::Parameter> values{};
  static void fields(auto& archive, auto& message) {
    call_fields(archive, message);
    archive.list(message.values, 32, kMostParameters, [&](auto& each) { descriptor_fields(archive, each); });
  }
};

}  // namespace chicane::protocol
