// SPDX-License-Identifier: MIT
// Recordings: reads their events in order, computes and compares every command, and makes bags and copies.
#include "chicane/recording/replay.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/run/setting.hpp"

namespace chicane::recording {
namespace {

/// Chooses the arithmetic `wanted` of a recording for all later controllers.
Result<void> choose_arithmetic(const std::string& wanted, const std::string& path) {
  if (wanted.empty() || arithmetic(chosen_instruction_set()) == wanted) return {};
  using enum InstructionSet;
  for (const InstructionSet set : {kAvx512, kAvx2, kNeon, kBaseline}) {
    if (!is_available(set) || arithmetic(set) != wanted) continue;
    choose_instruction_set(set);
    return {};
  }
  for (const InstructionSet set : {kAvx512, kAvx2, kNeon, kBaseline}) {
    if (!is_supported(set) || arithmetic(set) != wanted) continue;
    return fail(ErrorCode::kInvalidArgument, path + ": arithmetic: got \"" + wanted + "\", which needs " +
                                                 std::string(to_string(set)) + ": that was not built in. " +
                                                 how_to_build(to_string(set)));
  }
  return fail(ErrorCode::kInvalidArgument,
              path + ": arithmetic: got \"" + wanted + "\", expected \"" +
                  std::string(arithmetic(chosen_instruction_set())) +
                  "\", which is all that this processor has: use one like that it was recorded on");
}

Result<scenario::Scenario> parse_scenario(std::string_view yaml, const std::string& file) {
  const Result<protocol::Document> document = protocol::parse_document(yaml, file);
  if (!document) return fail(document.error());
  scenario::Scenario scenario;
  const std::array layers{*document};
  if (Result<void> applied = protocol::apply_layers(layers, scenario); !applied) return fail(applied.error());
  return scenario;
}

/// Reads the events of a recording.
class RecordingReader {
 public:
  RecordingReader(const std::string& path, RecordingHead& head,
                  const std::function<Result<void>(const RecordedEvent&)>& visit)
      : path_{path}, head_{head}, visit_{visit} {}

  Result<telemetry::McapReport> read() {
    Result<telemetry::McapReport> report = telemetry::read_mcap(
        path_,
        {.on_message = [this](const telemetry::McapMessage& message) { take(message); },
         .on_attachment = [this](std::string_view name, std::string_view bytes) { take(name, bytes); },
         .on_metadata = [this](std::string_view name,
                               const std::map<std::string, std::string>& entries) { take(name, entries); }});
    if (!report) return report;
    if (!state_) return fail(state_.error());
    if (!has_scenario_) {
      return fail(ErrorCode::kParse,
                  path_ + ": " + kRecordedScenario + ": got none, expected a recording of chicane");
    }
    report->damaged += damaged_;
    return report;
  }

 private:
  void take(const telemetry::McapMessage& message) {
    if (!state_ || !has_scenario_) return;
    if (message.channel.topic == protocol::kChangeTopic) {
      const auto change = protocol::decode_change(message.bytes);
      if (!change) ++damaged_;
      if (change) state_ = visit_(*change);
    } else if (message.channel.topic == protocol::kStepTopic) {
      const auto step = protocol::decode_step(message.bytes);
      if (!step) ++damaged_;
      if (step) state_ = visit_(RecordedStep{*step, 1e-9 * static_cast<double>(message.log_time)});
    }
  }

  void take(std::string_view name, std::string_view bytes) {
    if (name != kRecordedScenario || !state_) return;
    const Result<scenario::Scenario> scenario = parse_scenario(bytes, path_ + ":" + kRecordedScenario);
    has_scenario_ = true;
    state_ = scenario ? visit_(*scenario) : fail(scenario.error());
  }

  void take(std::string_view name, const std::map<std::string, std::string>& entries) {
    if (name != kRecordedRun || !state_) return;
    head_.entries.clear();
    head_.entries.insert(entries.begin(), entries.end());
    state_ = choose_arithmetic(head_["arithmetic"], path_);
    if (head_["mode"] == kSimulateMode) {
      state_ = fail(ErrorCode::kInvalidArgument,
                    path_ +
                        ": mode: got simulate, expected drive or serve: the commands came from another "
                        "program, and are not ours to compute");
    }
  }

  const std::string& path_;
  RecordingHead& head_;
  const std::function<Result<void>(const RecordedEvent&)>& visit_;
  Result<void> state_;
  bool has_scenario_ = false;  ///< a scenario was read
  std::uint64_t damaged_ = 0;  ///< messages that could not be decoded
};

}  // namespace

Result<telemetry::McapReport> read_recording(const std::string& path, RecordingHead& head,
                                             const std::function<Result<void>(const RecordedEvent&)>& visit) {
  return RecordingReader(path, head, visit).read();
}

Result<scenario::Scenario> recorded_scenario(const std::string& path) {
  RecordingHead head;
  std::optional<scenario::Scenario> first;
  const auto read = read_recording(path, head, [&](const RecordedEvent& event) -> Result<void> {
    if (const auto* scenario = std::get_if<scenario::Scenario>(&event)) first = *scenario;
    return fail(ErrorCode::kInvalidArgument, path + ": read as far as needed");
  });
  if (!first) return fail(read ? Error{ErrorCode::kParse, path + ": scenario: got none"} : read.error());
  if (head["mode"] == "serve") {
    return fail(ErrorCode::kInvalidArgument, path + ": mode: got serve, expected drive");
  }
  return *first;
}

bool is_foreign_log(const std::string& file) {
  std::error_code trouble;
  if (std::filesystem::is_directory(file, trouble)) return true;  // a bag of rosbag2
  if (file.ends_with(".db3") || file.ends_with(".csv")) return true;
  if (!file.ends_with(".mcap")) return false;
  bool is_ours = false, has_odometry = false;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    is_ours |= message.channel.topic == kFrameTopic;
    has_odometry = has_odometry || (message.channel.type == protocol::OdometryMessage::kType &&
                                    message.channel.message_encoding == "cdr" &&
                                    protocol::decode<protocol::OdometryMessage>(message.bytes).has_value());
  };
  return telemetry::read_mcap(file, visitor) && has_odometry && !is_ours;
}

Result<telemetry::McapReport> check_recording(const std::string& path) {
  std::uint64_t steps = 0;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    steps += message.channel.topic == kFrameTopic ? 1U : 0U;
  };
  const Result<telemetry::McapReport> read = telemetry::read_mcap(path, visitor);
  const bool is_cut = read && !read->is_complete && read->messages == 0;
  if (read && steps == 0)
    return fail(refusal(path, is_cut ? "a file that was cut in its first chunk" : "no control step",
                        "a recording of ours, or a bag with nav_msgs/msg/Odometry in CDR",
                        ErrorCode::kParse));
  return read;
}

namespace {

/// Control cycles of a recorded run, computed again.
class Recomputation {
 public:
  Recomputation(const scenario::Scenario& scenario, std::unique_ptr<controller::Controller> controller,
                std::optional<road::Track> track, std::shared_ptr<const road::RacingRoad> lap)
      : scenario_{scenario},
        track_{std::move(track)},
        cycle_{std::move(controller), scenario, track_ ? &*track_ : nullptr} {
    cycle_.use_line(std::move(lap));
  }

  /// Applies a change, unless it concerns neither controller nor vehicle.
  void add(const telemetry::Change& change) {
    const Result<run::Setting> setting = run::read_setting(change);
    if (!setting) return;
    if (const auto* learned = std::get_if<run::LearnedLap>(&setting->action)) {
      controller::LapRequest request = cycle_.controller().wants_lap();
      request.terms = *learned;
      const auto lap = run::plan_wanted_lap(scenario_, track_ ? &*track_ : nullptr, request);
      if (lap) cycle_.use_line(*lap);
    }
    const auto* field = std::get_if<run::FieldValue>(&setting->action);
    if (field == nullptr) return;
    run::write(scenario_, *field);
    cycle_.configure(scenario_);
  }

  void add(const protocol::Step& step, ReplayReport& report) {
    ++report.steps;
    if (step.deadline_spent_at > 0) ++report.late;
    if (step.begins) cycle_.begin(step.cycle, step.longest_interval);
    if (step.cycle != cycle_.next()) {
      ++report.unknown;
      return;
    }
    const bool has_difference = !is_reproduced(step);
    ++(has_difference ? report.different : report.identical);
    if (has_difference && !report.first_difference) report.first_difference = step.cycle;
  }

 private:
  /// Computes a step; true if it equals the recorded one.
  bool is_reproduced(const protocol::Step& step) {
    frame_.measurement = step.measurement;
    frame_.has_measurement = step.has_measurement;
    cycle_.step({.deadline = Deadline::never(),
                 .deadline_spent_at = step.deadline_spent_at,
                 .interval = step.gate_interval,
                 .manual = step.manual},
                frame_);
    const controller::StepResult& result = frame_.result;
    return is_same_number(result.command.steer, step.command.steer) &&
           is_same_number(result.command.throttle, step.command.throttle) && frame_.guard.rung == step.rung &&
           frame_.guard.gated == step.gated;
  }

  scenario::Scenario scenario_;
  std::optional<road::Track> track_;  ///< track known to guard and racing controller
  run::ControlCycle cycle_;
  telemetry::Frame frame_;
};

}  // namespace

Result<ReplayReport> verify_recording(const std::string& path, const run::Factories& make) {
  ReplayReport report;
  RecordingHead head;
  std::unique_ptr<Recomputation> again;
  const auto visit = [&](const RecordedEvent& event) -> Result<void> {
    if (const auto* scenario = std::get_if<scenario::Scenario>(&event)) {
      auto controller = make.controller(*scenario);
      if (!controller) return fail(controller.error());
      std::optional<road::Track> track;
      if (scenario->guard.road == safety::GuardRoad::kTrack) {
        auto found = make.track(*scenario);
        if (!found) return fail(found.error());
        track = std::move(*found);
      }
      auto lap = run::plan_lap(*scenario, track ? &*track : nullptr);
      if (!lap) return fail(lap.error());
      again = std::make_unique<Recomputation>(*scenario, std::move(*controller), std::move(track),
                                              std::move(*lap));
    } else if (const auto* change = std::get_if<telemetry::Change>(&event)) {
      again->add(*change);
    } else {
      again->add(std::get<RecordedStep>(event).step, report);
    }
    return {};
  };
  const Result<telemetry::McapReport> read = read_recording(path, head, visit);
  if (!read) return fail(read.error());
  if (report.steps == 0) {
    return fail(ErrorCode::kParse,
                path + ": steps: got none" +
                    (read->damaged > 0 ? " and " + std::to_string(read->damaged) + " unreadable parts"
                                       : std::string(read->is_complete ? "" : " before the file's end")) +
                    ", expected a recording with control steps to compute again");
  }
  report.recorded_by = head["program"];
  report.controller = head["controller"];
  report.track = head["track"];
  report.damaged = read->damaged;
  report.is_complete = read->is_complete;
  return report;
}

namespace {

namespace fs = std::filesystem;

/// Content of a recording for metadata.yaml.
struct Contents {
  /// Type and number of messages by topic.
  std::map<std::string, std::pair<std::string, std::uint64_t>> topics{};
  std::uint64_t messages = 0;                                       ///< messages of all topics
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();  ///< log time of the first message [ns]
  std::uint64_t last = 0;                                           ///< log time of the last message [ns]
};

Result<Contents> contents_of(const std::string& recording) {
  Contents contents;
  const auto read =
      telemetry::read_mcap(recording, {.on_message = [&](const telemetry::McapMessage& message) {
                             if (message.channel.message_encoding != "cdr") return;
                             auto& [type, count] = contents.topics[message.channel.topic];
                             type = message.channel.type;
                             ++count;
                             ++contents.messages;
                             contents.first = std::min(contents.first, message.log_time);
                             contents.last = std::max(contents.last, message.log_time);
                           }});
  if (!read) return fail(read.error());
  contents.first = std::min(contents.first, contents.last);
  return contents;
}

std::string as_yaml(const Contents& contents, const std::string& file) {
  const std::uint64_t duration = contents.last - contents.first;
  std::string text = fmt::format(
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
      "  duration:\n    nanoseconds: {}\n  starting_time:\n    nanoseconds_since_epoch: {}\n"
      "  message_count: {}\n  topics_with_message_count:\n",
      duration, contents.first, contents.messages);
  for (const auto& [topic, what] : contents.topics) {
    text += fmt::format(
        "    - topic_metadata:\n        name: {}\n        type: {}\n        serialization_format: cdr\n"
        "        offered_qos_profiles: \"\"\n      message_count: {}\n",
        topic, what.first, what.second);
  }
  text += fmt::format(
      "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - \"{0}\"\n  "
      "files:\n"
      "    - path: \"{0}\"\n      starting_time:\n        nanoseconds_since_epoch: {1}\n"
      "      duration:\n        nanoseconds: {2}\n      message_count: {3}\n",
      file, contents.first, duration, contents.messages);
  return text;
}

std::string name_of(const std::string& recording) { return fs::path(recording).filename().string(); }

}  // namespace

std::string bag_metadata_path(const std::string& recording) {
  return (fs::path(recording).parent_path() / "metadata.yaml").string();
}

Result<void> can_be_bag(const std::string& recording) {
  const std::string path = bag_metadata_path(recording);
  const Result<std::string> before = protocol::read_file(path);
  if (!before || before->find("\"" + name_of(recording) + "\"") != std::string::npos) return {};
  return fail(
      ErrorCode::kInvalidArgument,
      fmt::format("--bag: got a folder with the bag of another recording ({}), expected one of its own",
                  path));
}

Result<void> write_bag_metadata(const std::string& recording) {
  const Result<Contents> contents = contents_of(recording);
  if (!contents) return fail(contents.error());
  return write_file(bag_metadata_path(recording), as_yaml(*contents, name_of(recording)));
}

Result<telemetry::McapReport> indexed_copy(const std::string& from, const std::string& to) {
  const auto writer = telemetry::McapWriter::create(to, "chicane");
  if (!writer) return fail(writer.error());
  std::map<std::uint16_t, std::uint16_t> channels;  // channels of the copy by channels of the recording
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

TemporaryFile::TemporaryFile(std::string_view extension) {
  static std::atomic<unsigned> number{0};
  std::error_code error;
  std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) folder = ".";
  path_ = (folder / fmt::format("chicane-{}-{}{}", ::getpid(), number++, extension)).string();
  std::filesystem::remove(path_, error);  // a file of a killed process with the same id
}

TemporaryFile::~TemporaryFile() {
  std::error_code error;
  std::filesystem::remove(path_, error);
}

}  // namespace chicane::recording
