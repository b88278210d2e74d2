// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/recording/detail/ros_message.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "conversion.hpp"
#include "faces.hpp"

namespace chicane::python {
namespace {

using recording::RosContent;
using recording::RosReader;
using Columns = std::map<std::string, std::vector<double>>;
using Row = std::map<std::string, double>;

/// What a recording of ours holds: its frames, completed laps, road and description. Of several runs in one
/// file the last.
class RecordingReader {
 public:
  Result<void> add(const telemetry::McapMessage& message) {
    const std::string& topic = message.channel.topic;
    const bool is_frame = topic == "/chicane/frame", is_lap = topic == "/chicane/lap",
               is_run = topic == "/chicane/run";
    const bool is_line = topic.starts_with("/track/");
    if (!is_frame && !is_lap && !is_run && !is_line) return {};
    const Result<RosContent> content = read(message);
    if (!content) return fail(content.error().code, topic + ": " + content.error().message);
    if (is_frame) add_frame(*content);
    if (is_run) controller_ = content->text("controller");
    if (is_lap) laps_.push_back(first_of_each(*content));
    if (is_line) add_line(topic.substr(std::string("/track/").size()), *content);
    return {};
  }
  void add(const std::map<std::string, std::string>& entries) { head_ = entries; }

  [[nodiscard]] bool has_frames() const noexcept { return !columns_.empty(); }
  /// With the interpreter's lock; gives everything away.
  [[nodiscard]] py::dict take() {
    py::dict frames, road, result;
    for (auto& [name, values] : columns_) frames[py::str(name)] = to_array(std::move(values));
    for (auto& [name, points] : road_) road[py::str(name)] = to_array(points);
    if (!controller_.empty()) head_["controller"] = controller_;  // also one that is none of the library's
    result["head"] = head_;
    result["frames"] = frames;
    result["laps"] = laps_;
    result["road"] = road;
    return result;
  }

 private:
  Result<RosContent> read(const telemetry::McapMessage& message) {
    auto reader = readers_.find(message.channel.id);
    if (reader == readers_.end()) {
      Result<RosReader> made = RosReader::create(message.channel.schema);
      if (!made) return fail(made.error());
      reader = readers_.emplace(message.channel.id, std::move(*made)).first;
    }
    return reader->second.read(message.bytes);
  }
  void add_frame(const RosContent& frame) {
    const double time = frame.number("time_s");
    if (time < last_time_) {  // another run begins
      columns_.clear();
      laps_.clear();
    }
    last_time_ = time;
    for (const auto& [name, values] : frame.numbers) {
      const bool is_list = values.size() != 1 || name == "cost_terms" || name.starts_with("stamp");
      if (!is_list) columns_[name].push_back(values.front());
    }
  }
  static Row first_of_each(const RosContent& content) {
    Row row;
    for (const auto& [name, values] : content.numbers) {
      if (values.size() == 1 && !name.starts_with("stamp")) row[name] = values.front();
    }
    return row;
  }
  void add_line(const std::string& name, const RosContent& content) {
    const std::vector<double>& x = content.list("poses.pose.position.x");
    const std::vector<double>& y = content.list("poses.pose.position.y");
    std::vector<Vec2>& points = road_[name];
    points.clear();
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) points.emplace_back(x[i], y[i]);
  }

  std::map<std::uint16_t, RosReader> readers_;
  std::map<std::string, std::string> head_;
  std::string controller_;
  Columns columns_;
  std::map<std::string, std::vector<Vec2>> road_;
  std::vector<Row> laps_;
  double last_time_ = -1.0;
};

Result<RecordingReader> read_all(const std::string& path) {
  RecordingReader reader;
  Result<void> state;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    if (state) state = reader.add(message);
  };
  visitor.on_metadata = [&](std::string_view name, const std::map<std::string, std::string>& entries) {
    if (name == "run") reader.add(entries);
  };
  const Result<telemetry::McapReport> report = telemetry::read_mcap(path, visitor);
  if (!report) return fail(report.error());
  if (!state) return fail(state.error().code, path + ": " + state.error().message);
  if (!reader.has_frames())
    return fail(ErrorCode::kParse,
                path + ": got a recording without /chicane/frame, expected one of chicane");
  return reader;
}

}  // namespace

void add_recording(py::module_& module) {
  module.def(
      "read",
      [](const std::string& path) { return value_of(unlocked([&] { return read_all(path); })).take(); },
      py::arg("path"));
}

}  // namespace chicane::python
