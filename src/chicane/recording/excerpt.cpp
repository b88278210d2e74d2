// SPDX-License-Identifier: MIT
#include "chicane/recording/excerpt.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "chicane/telemetry/mcap_writer.hpp"

namespace chicane::recording {
namespace {

/// The copy while it grows.
class Copy {
 public:
  Copy(const ExcerptOptions& options, telemetry::McapWriter& writer) : options_{options}, writer_{writer} {}

  void add(const telemetry::McapMessage& message) {
    const telemetry::McapChannel& channel = message.channel;
    const bool is_wanted =
        options_.topics.empty() ||
        std::find(options_.topics.begin(), options_.topics.end(), channel.topic) != options_.topics.end();
    if (!is_wanted) return;
    const auto [place, is_new] = channels_.try_emplace(channel.id);
    if (is_new) place->second.id = writer_.add_channel(channel.topic, channel.type, channel.schema);
    // Constants come at the time 0 and anew with a run: never too often.
    if (options_.rate > 0.0 && !is_new && message.log_time < place->second.next) return;
    const auto period = static_cast<std::uint64_t>(options_.rate > 0.0 ? 1e9 / options_.rate : 0.0);
    place->second.next = std::max(place->second.next + period, message.log_time + period / 2);
    keep(writer_.write(place->second.id, message.log_time, message.publish_time, message.bytes));
  }
  void add(std::string_view name, std::string_view bytes) {
    if (options_.has_attachments) keep(writer_.add_attachment(name, "application/yaml", bytes));
  }
  void add(std::string_view name, const std::map<std::string, std::string>& entries) {
    if (options_.has_attachments) keep(writer_.add_metadata(name, entries));
  }
  void keep(Result<void> done) {
    if (state_ && !done) state_ = std::move(done);
  }
  [[nodiscard]] const Result<void>& state() const { return state_; }

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint64_t next = 0;  ///< not before this log time [ns]
  };
  const ExcerptOptions& options_;
  telemetry::McapWriter& writer_;
  std::map<std::uint16_t, Channel> channels_;
  Result<void> state_;
};

}  // namespace

Result<telemetry::McapReport> excerpt(const std::string& from, const std::string& to,
                                      const ExcerptOptions& options) {
  const auto writer = telemetry::McapWriter::create(to, "chicane");
  if (!writer) return fail(writer.error());
  Copy copy(options, **writer);
  const auto read = telemetry::read_mcap(
      from, {.on_message = [&](const telemetry::McapMessage& message) { copy.add(message); },
             .on_attachment = [&](std::string_view name, std::string_view bytes) { copy.add(name, bytes); },
             .on_metadata = [&](std::string_view name, const auto& entries) { copy.add(name, entries); }});
  if (!read) return fail(read.error());
  copy.keep((*writer)->close());
  if (!copy.state()) return fail(copy.state().error());
  return *read;
}

}  // namespace chicane::recording
