// SPDX-License-Identifier: MIT
// Recorder of a run: takes records from the control thread through a ring, and writes them on another thread.
#include "chicane/recording/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "chicane/base/instruction_set.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/version.hpp"

namespace chicane::recording {
namespace {

using Clock = std::chrono::steady_clock;
// Periods, chosen.
constexpr auto kFlushEvery = std::chrono::milliseconds(50);      // of writing the chunk to the file
constexpr auto kTryAgainEvery = std::chrono::milliseconds(500);  // of the same while the disk fails
constexpr auto kRingPoll = std::chrono::milliseconds(2);         // of looking for records in an empty ring
constexpr auto kRoomPoll = std::chrono::microseconds(200);       // of looking for room in a full ring
constexpr const char* kProgram = "chicane " CHICANE_VERSION;
#ifdef __clang__
constexpr const char* kCompiler = "clang " __VERSION__;
#else
constexpr const char* kCompiler = "gcc " __VERSION__;
#endif

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::create(RecorderOptions options) {
  auto writer = telemetry::McapWriter::create(options.path, kProgram, options.is_compressed);
  if (!writer) return fail(writer.error());
  std::unique_ptr<Recorder> recorder(new Recorder(std::move(options), std::move(*writer)));
  recorder->begin();
  if (!recorder->state_) return fail(recorder->state_.error());
  recorder->thread_ = std::thread([it = recorder.get()] { it->work(); });
  return recorder;
}

Recorder::Recorder(RecorderOptions options, std::unique_ptr<telemetry::McapWriter> writer)
    : options_{std::move(options)}, writer_{std::move(writer)} {}

Recorder::~Recorder() { static_cast<void>(finish()); }

template <class Note>
void Recorder::record(Note&& note, std::uint64_t reserve) noexcept {
  while (!ring_.push(std::forward<Note>(note), reserve)) {
    if (!options_.may_wait) {
      ++left_out_;
      return;
    }
    std::this_thread::sleep_for(kRoomPoll);
  }
}

void Recorder::record(const telemetry::Frame& frame) noexcept { record(frame, kReserve); }

void Recorder::record(const telemetry::Change& change) noexcept { record(change, 0); }

void Recorder::record(const telemetry::CompletedLap& lap) noexcept { record(lap, 0); }

void Recorder::record(std::unique_ptr<const RecordedRun> run) noexcept { record(std::move(run), 0); }

void Recorder::record(std::shared_ptr<const lap_time::LimitAnswer> limit) noexcept {
  record(std::move(limit), 0);
}

Result<RecorderReport> Recorder::finish() {
  wants_end_ = true;
  if (thread_.joinable()) thread_.join();
  if (!state_) return fail(state_.error());
  return RecorderReport{
      .frames = frames_, .left_out = left_out_, .missing = missing_, .bytes = writer_->bytes_written()};
}

void Recorder::work() {
  Clock::time_point flushed = Clock::now();
  while (true) {
    const bool is_last =
        wants_end_.load(std::memory_order_acquire);  // read before the ring, to lose no record
    Entry* const entry = ring_.front();
    if (entry != nullptr) {
      std::visit([this](auto& note) { write(note); }, *entry);
      ring_.pop();
    }
    if (Clock::now() - flushed >= (is_failing_ ? kTryAgainEvery : kFlushEvery)) {
      note(flush());
      flushed = Clock::now();
    }
    if (entry != nullptr) continue;
    if (is_last) break;
    std::this_thread::sleep_for(kRingPoll);
  }
  Result<void> done = flush();
  if (done) done = writer_->close();
  if (!done) {
    state_ = fail(done.error().code,
                  fmt::format("{}{}", done.error().message,
                              missing_ > 0 ? fmt::format("; {} steps are missing", missing_) : ""));
  }
}

Result<void> Recorder::flush() {
  Result<void> done = writer_->flush();
  if (!done || !is_undescribed_) return done;
  done = describe();
  is_undescribed_ = !done;
  return done ? writer_->flush() : done;
}

void Recorder::note(const Result<void>& flushed) {
  if (is_failing_ == !flushed) return;
  is_failing_ = !flushed;
  if (!options_.say) return;
  options_.say(is_failing_
                   ? flushed.error().message + "; trying again, steps until then will be missing"
                   : fmt::format("{}: can be written again; {} steps are missing", options_.path, missing_));
}

void Recorder::begin() {
  for (const protocol::RosTopic& topic : protocol::ros_topics()) {
    const std::uint16_t channel = writer_->add_channel(topic.name, topic.type, topic.schema);
    if (topic.name == protocol::kChangeTopic) change_channel_ = channel;
  }
  step_channel_ = writer_->add_channel(protocol::kStepTopic, protocol::kStepType, protocol::step_schema());
  state_ = describe();
  if (state_) state_ = writer_->flush();
}

Result<void> Recorder::describe() {
  const scenario::Scenario& scenario = options_.scenario;
  const InstructionSet set = chosen_instruction_set();
  const protocol::GuardFacts guard = protocol::guard_facts(scenario.guard);
  Result<void> done =
      writer_->add_metadata(kRecordedRun, {{"program", kProgram},
                                           {"compiler", kCompiler},
                                           {"instruction_set", std::string(to_string(set))},
                                           {"arithmetic", std::string(arithmetic(set))},
                                           {"mode", options_.run.mode},
                                           {"track", options_.run.track},
                                           {"controller", scenario.controller},
                                           {"preset", scenario.preset},
                                           {"guard_mode", guard.mode},
                                           {"guard_road", guard.road},
                                           {"guard_version", fmt::format("{}", guard.version)},
                                           {"seed", fmt::format("{}", scenario.seed)},
                                           {"step_budget_s", fmt::format("{}", options_.step_budget)}});
  if (!done) return done;
  done = writer_->add_attachment(
      kRecordedScenario, "application/yaml",
      protocol::write_document(scenario, fmt::format("What was recorded by {}", kProgram), true));
  if (!done) return done;
  write(protocol::Cadence::kRun);
  write(protocol::Cadence::kRoad);
  if (options_.run.limit.found || !options_.run.limit.why_not.empty()) write(protocol::Cadence::kLimit);
  return {};
}

void Recorder::put(std::uint16_t channel, std::uint64_t log_time, std::uint64_t time,
                   std::string_view bytes) {
  if (const Result<void> done = writer_->write(channel, log_time, time, bytes); !done) note(done);
}

void Recorder::write(protocol::Cadence cadence, const telemetry::Frame& frame, std::uint64_t time) {
  std::uint16_t channel = 0;
  for (const protocol::RosTopic& topic : protocol::ros_topics()) {
    if (topic.cadence == cadence) put(channel, last_log_time_, time, topic.encode(frame, options_.run));
    ++channel;
  }
}

void Recorder::write(std::shared_ptr<const lap_time::LimitAnswer>& limit) {
  options_.run.limit = *limit;
  limit.reset();
  write(protocol::Cadence::kLimit);
}

void Recorder::write(std::unique_ptr<const RecordedRun>& run) {
  options_.run = run->run;
  options_.scenario = run->scenario;
  run.reset();
  ledger_.begin();
  is_undescribed_ = true;
  note(flush());  // before the frames of the run
}

void Recorder::write(const telemetry::Change& change) {
  ledger_.add(change);
  const std::uint64_t time = protocol::to_nanoseconds(change.time);
  const std::uint64_t log_time = std::max(last_log_time_, time + earlier_runs_);
  put(change_channel_, log_time, time,
      protocol::encode_change(change.time, change.cycle, change.name.view(), change.value.view()));
}

void Recorder::write(const telemetry::CompletedLap& lap) {
  telemetry::Frame frame;
  frame.completed_lap = lap;
  options_.run.lap_setup = ledger_.setup(last_time_, lap.lap_time);
  write(protocol::Cadence::kLap, frame);
}

void Recorder::write(const telemetry::Frame& frame) {
  if (is_failing_) {
    ++missing_;
    return;
  }
  const std::uint64_t time = protocol::to_nanoseconds(frame.time);
  if (frame.time < last_time_) ledger_.restart();
  last_time_ = frame.time;
  if (time + earlier_runs_ < last_log_time_) {  // the run restarted
    earlier_runs_ = last_log_time_ + protocol::to_nanoseconds(options_.scenario.control_period) - time;
  }
  last_log_time_ = time + earlier_runs_;
  write(protocol::Cadence::kFrame, frame, time);
  put(step_channel_, last_log_time_, time, protocol::encode_step(frame));
  ++frames_;
}

}  // namespace chicane::recording
