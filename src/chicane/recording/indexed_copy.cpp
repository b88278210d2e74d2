// SPDX-License-Identifier: MIT
#include "chicane/recording/indexed_copy.hpp"

#include <map>
#include <utility>

#include "chicane/telemetry/mcap_writer.hpp"

namespace chicane::recording {

Result<telemetry::McapReport> indexed_copy(const std::string& from, const std::string& to) {
  const auto writer = telemetry::McapWriter::create(to, "chicane");
  if (!writer) return fail(writer.error());
  std::map<std::uint16_t, std::uint16_t> channels;  // of the copy, by those of the recording
  Result<void> state;
  const auto keep = [&](Result<void> done) {
    if (state && !done) state = std::move(done);
  };
  const auto read = telemetry::read_mcap(
      from,
      {.on_message =
           [&](const telemetry::McapMessage& message) {
             const telemetry::McapChannel& channel = message.channel;
             const auto [place, is_new] = channels.try_emplace(channel.id);
             if (is_new) place->second = (*writer)->add_channel(channel.topic, channel.type, channel.schema);
             keep((*writer)->write(place->second, message.log_time, message.publish_time, message.bytes));
           },
       .on_attachment =
           [&](std::string_view name, std::string_view bytes) {
             keep((*writer)->add_attachment(name, "application/yaml", bytes));
           },
       .on_metadata = [&](std::string_view name,
                          const auto& entries) { keep((*writer)->add_metadata(name, entries)); }});
  if (!read) return fail(read.error());
  keep((*writer)->close());
  if (!state) return fail(state.error());
  return *read;
}

}  // namespace chicane::recording
