// SPDX-License-Identifier: MIT
// Readers of recordings of this program, and of bags of ROS 2 in MCAP files or SQLite.
#include "chicane/identify/detail/log_rows.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <memory>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/telemetry/mcap.hpp"

namespace chicane::identify {
namespace {

constexpr std::string_view kOdometry = protocol::OdometryMessage::kType;
constexpr std::string_view kDrive = protocol::DriveMessage::kType;

/// Rows of the topic `wanted`, or if that is empty of the only topic. `option`: the option that names one.
template <class Row>
Result<std::vector<Row>> chosen(const std::map<std::string, std::vector<Row>>& topics,
                                const std::string& wanted, std::string_view type, const char* option,
                                const std::string& file) {
  if (const auto named = topics.find(wanted); named != topics.end()) return named->second;
  if (wanted.empty() && topics.size() == 1) return topics.begin()->second;
  std::string names;
  for (const auto& [topic, rows] : topics) names += (names.empty() ? "" : ", ") + printable(topic);
  if (topics.empty()) names = "none";
  return fail(ErrorCode::kParse, fmt::format("{}: got the topics {} of {}, expected one; name it by {}", file,
                                             names, type, option));
}

}  // namespace

double RosRows::seconds(std::int64_t stamp, std::uint64_t log_time) {
  const std::int64_t now = stamp != 0 ? stamp : static_cast<std::int64_t>(log_time);
  if (!first_) first_ = now;
  return 1e-9 * static_cast<double>(now - *first_);
}

void RosRows::add(const std::string& topic, std::string_view type, std::string_view bytes,
                  std::uint64_t log_time) {
  if (type == kOdometry) {
    if (const auto odom = protocol::decode<protocol::OdometryMessage>(bytes))
      samples_[topic].push_back({seconds(odom->stamp, log_time), odom->pose.x, odom->pose.y, odom->pose.psi,
                                 hypot(odom->vx, odom->vy), odom->yaw_rate});
  } else if (type == kDrive) {
    if (const auto command = protocol::decode<protocol::DriveMessage>(bytes))
      commands_[topic].push_back({.time = seconds(command->stamp, log_time), .steer = command->steer});
  }
}

Result<LogRows> RosRows::rows(const std::string& file, const LogOptions& options) const {
  auto samples = chosen(samples_, options.odom_topic, kOdometry, "--odom-topic", file);
  if (!samples) return fail(samples.error());
  if (commands_.empty() && !options.needs_commands) return LogRows{std::move(*samples), {}, false};
  auto commands = chosen(commands_, options.drive_topic, kDrive, "--drive-topic", file);
  if (!commands) return fail(commands.error());
  return LogRows{std::move(*samples), std::move(*commands), false};
}

Result<LogRows> read_mcap_rows(const std::string& file, const LogOptions& options) {
  LogRows own;
  RosRows foreign;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    const telemetry::McapChannel& channel = message.channel;
    if (channel.topic == protocol::kStepTopic && channel.type == protocol::kStepType) {
      const auto step = protocol::decode_step(message.bytes);
      if (!step) return;
      const model::Measurement& m = step->measurement;
      if (step->has_measurement)
        own.samples.push_back({.time = m.time, .x = m.x, .y = m.y, .psi = m.psi, .speed = m.speed});
      own.commands.push_back({m.time, step->command.steer, step->command.throttle});
    } else if (channel.message_encoding == "cdr") {
      foreign.add(channel.topic, channel.type, message.bytes, message.log_time);
    }
  };
  const auto read = telemetry::read_mcap(file, visitor);
  if (!read) return fail(read.error());
  if (own.commands.empty()) return foreign.rows(file, options);
  own.is_centre_of_mass = true;
  return own;
}

namespace {

// Limits of what a file of a stranger may take; chosen.
constexpr int kMostBytes = 16 << 20;             // size of one message [byte]
constexpr int kMostTopics = 10'000;              // number of topics
constexpr int kMostOperations = 10'000;          // operations of one compiled query
constexpr long long kMostSteps = 2'000'000'000;  // steps of SQLite's machine: some minutes
constexpr int kStepsBetween = 100'000;           // steps between two checks of kMostSteps

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

/// Bag in a database that is opened for reading, with limits on work and memory: a file may have any schema
/// and any bytes.
class Bag {
 public:
  explicit Bag(std::string file) : file_{std::move(file)} {}

  /// Reads the rows of the selected topics.
  Result<LogRows> read(const LogOptions& options) {
    if (const Result<void> opened = open(); !opened) return fail(opened.error());
    std::map<long long, std::pair<std::string, std::string>> topics;  // name and type
    const Result<void> named =
        each("SELECT id, name, type FROM topics WHERE serialization_format = 'cdr'", [&](sqlite3_stmt* row) {
          if (topics.size() < kMostTopics)
            topics[sqlite3_column_int64(row, 0)] = {text(row, 1), text(row, 2)};
        });
    if (!named) return fail(named.error());
    RosRows rows;
    const Result<void> read =
        each("SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp", [&](sqlite3_stmt* row) {
          const auto topic = topics.find(sqlite3_column_int64(row, 0));
          if (topic == topics.end()) return;
          const auto* const bytes = static_cast<const char*>(sqlite3_column_blob(row, 2));
          const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, 2));
          if (bytes != nullptr)
            rows.add(topic->second.first, topic->second.second, {bytes, size},
                     static_cast<std::uint64_t>(sqlite3_column_int64(row, 1)));
        });
    if (!read) return fail(read.error());
    return rows.rows(file_, options);
  }

 private:
  /// Text of a column.
  static std::string text(sqlite3_stmt* row, int column) {
    const auto* const bytes = static_cast<const char*>(sqlite3_column_blob(row, column));
    return bytes == nullptr ? ""
                            : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
  }

  /// Error with the reason of SQLite, or that the work had no end.
  Result<void> fault(ErrorCode code) const {
    const std::string why = has_ended_ ? "too much work to read it" : sqlite3_errmsg(database_.get());
    return fail(code, fmt::format("{}: got a bag that cannot be read: {}, expected a database of rosbag2",
                                  file_, printable(why)));
  }

  /// Opens the database without trust in its schema.
  Result<void> open() {
    sqlite3* raw = nullptr;
    const int opened =
        sqlite3_open_v2(file_.c_str(), &raw, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    database_.reset(raw);
    if (opened != SQLITE_OK) return fault(ErrorCode::kIo);
    sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, kMostBytes);
    sqlite3_limit(raw, SQLITE_LIMIT_VDBE_OP, kMostOperations);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_progress_handler(raw, kStepsBetween, &ends, this);
    return {};
  }

  /// Callback of SQLite: not 0 ends the query.
  static int ends(void* self) {
    Bag& bag = *static_cast<Bag*>(self);
    bag.steps_ += kStepsBetween;
    bag.has_ended_ = bag.steps_ > kMostSteps;
    return bag.has_ended_ ? 1 : 0;
  }

  /// Calls `visit` for each row of a query.
  template <class Visit>
  Result<void> each(const char* query, const Visit& visit) {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query, -1, &raw, nullptr) != SQLITE_OK)
      return fault(ErrorCode::kParse);
    const Statement statement(raw, &sqlite3_finalize);
    int step = sqlite3_step(raw);
    for (; step == SQLITE_ROW; step = sqlite3_step(raw)) visit(raw);
    return step == SQLITE_DONE ? Result<void>{} : fault(ErrorCode::kParse);
  }

  std::string file_;
  Database database_{nullptr, &sqlite3_close};
  long long steps_ = 0;     ///< steps of SQLite's machine so far
  bool has_ended_ = false;  ///< kMostSteps was exceeded
};

}  // namespace

Result<LogRows> read_sqlite_rows(const std::string& file, const LogOptions& options) {
  return Bag(file).read(options);
}

}  // namespace chicane::identify
