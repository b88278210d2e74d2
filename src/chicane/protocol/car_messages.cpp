// SPDX-License-Identifier: MIT
#include "chicane/protocol/car_messages.hpp"

#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/protocol/detail/cdr_source.hpp"
#include "chicane/protocol/detail/cdr_writer.hpp"

namespace chicane::protocol {
namespace {

CdrWriter& put_header(CdrWriter& to, std::int64_t stamp, std::string_view frame) {
  return to.stamp_ns(stamp).text(frame);
}

void put_pose(CdrWriter& to, const model::Pose& pose) { to.put(pose.x, pose.y, 0.0).orientation(pose.psi); }

/// Position and the yaw of an orientation that may also lean.
model::Pose get_pose(CdrSource& from) {
  model::Pose pose;
  pose.x = from.number();
  pose.y = from.number();
  from.number();
  const double x = from.number(), y = from.number(), z = from.number(), w = from.number();
  pose.psi = chicane::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
  return pose;
}

void skip_numbers(CdrSource& from, int number) {
  for (int i = 0; i < number; ++i) from.number();
}

template <class Message>
void get_header(CdrSource& from, Message& to) {
  to.stamp = from.stamp();
  to.frame = from.text();
}

template <class Message>
std::optional<Message> checked(const CdrSource& from, Message&& message) {
  if (!from.ok()) return std::nullopt;
  return std::forward<Message>(message);
}

}  // namespace

std::string encode(const OdometryMessage& message) {
  CdrWriter to{768};
  put_header(to, message.stamp, message.frame).text(message.child_frame);
  put_pose(to, message.pose);
  to.zeros(36).put(message.vx, message.vy, 0.0, 0.0, 0.0, message.yaw_rate).zeros(36);
  return to.bytes();
}

std::optional<OdometryMessage> decode_odometry(std::string_view bytes) {
  CdrSource from(bytes);
  OdometryMessage message;
  get_header(from, message);
  message.child_frame = from.text();
  message.pose = get_pose(from);
  skip_numbers(from, 36);
  message.vx = from.number();
  message.vy = from.number();
  skip_numbers(from, 3);
  message.yaw_rate = from.number();
  skip_numbers(from, 36);
  return checked(from, std::move(message));
}

std::string encode(const DriveMessage& message) {
  CdrWriter to{64};
  put_header(to, message.stamp, message.frame)
      .put(static_cast<float>(message.steer), 0.0F, static_cast<float>(message.speed),
           static_cast<float>(message.acceleration), 0.0F);
  return to.bytes();
}

std::optional<DriveMessage> decode_drive(std::string_view bytes) {
  CdrSource from(bytes);
  DriveMessage message;
  get_header(from, message);
  message.steer = static_cast<double>(from.get<float>());
  from.get<float>();
  message.speed = static_cast<double>(from.get<float>());
  message.acceleration = static_cast<double>(from.get<float>());
  from.get<float>();
  return checked(from, std::move(message));
}

std::string encode_autoware(const DriveMessage& message) {
  CdrWriter to{96};
  const auto times = [&] { to.stamp_ns(message.stamp).stamp_ns(message.stamp); };
  times();
  times();
  to.put(static_cast<float>(message.steer), 0.0F, false);
  times();
  to.put(static_cast<float>(message.speed), static_cast<float>(message.acceleration), 0.0F, true, false);
  return to.bytes();
}

std::string encode(const ImuMessage& message) {
  CdrWriter to{384};
  put_header(to, message.stamp, message.frame);
  // The first covariance is -1: there is no orientation.
  to.put(0.0, 0.0, 0.0, 1.0).put(-1.0).zeros(8);
  to.put(0.0, 0.0, message.yaw_rate).zeros(9).put(message.ax, message.ay, 0.0).zeros(9);
  return to.bytes();
}

std::optional<ImuMessage> decode_imu(std::string_view bytes) {
  CdrSource from(bytes);
  ImuMessage message;
  get_header(from, message);
  skip_numbers(from, 4 + 9 + 2);
  message.yaw_rate = from.number();
  skip_numbers(from, 9);
  message.ax = from.number();
  message.ay = from.number();
  skip_numbers(from, 1 + 9);
  return checked(from, std::move(message));
}

std::string encode(const PathMessage& message) {
  CdrWriter to{64 + 100 * message.points.size()};
  put_header(to, message.stamp, message.frame).count(message.points.size());
  double heading = 0.0;
  for (std::size_t i = 0; i < message.points.size(); ++i) {
    const Vec2& here = message.points[i];
    if (i + 1 < message.points.size()) {
      const Vec2 ahead = message.points[i + 1] - here;
      heading = chicane::atan2(ahead.y(), ahead.x());
    }
    put_header(to, message.stamp, message.frame);
    put_pose(to, {here.x(), here.y(), heading});
  }
  return to.bytes();
}

std::optional<PathMessage> decode_path(std::string_view bytes) {
  constexpr std::size_t kSmallestPose = 64;
  CdrSource from(bytes);
  PathMessage message;
  get_header(from, message);
  const std::uint32_t count = from.count(kSmallestPose);
  if (count > PathMessage::kCapacity) return std::nullopt;
  message.points.reserve(count);
  for (std::uint32_t i = 0; i < count && from.ok(); ++i) {
    from.stamp();
    from.text();
    const model::Pose pose = get_pose(from);
    if (!std::isfinite(pose.x) || !std::isfinite(pose.y)) return std::nullopt;
    message.points.emplace_back(pose.x, pose.y);
  }
  return checked(from, std::move(message));
}

std::string encode(const PoseMessage& message) {
  CdrWriter to{416};
  put_header(to, message.stamp, message.frame);
  put_pose(to, message.pose);
  to.zeros(36);
  return to.bytes();
}

std::optional<PoseMessage> decode_pose(std::string_view bytes) {
  CdrSource from(bytes);
  PoseMessage message;
  get_header(from, message);
  message.pose = get_pose(from);
  skip_numbers(from, 36);
  const bool is_finite =
      std::isfinite(message.pose.x) && std::isfinite(message.pose.y) && std::isfinite(message.pose.psi);
  if (!is_finite) return std::nullopt;
  return checked(from, std::move(message));
}

std::string encode(const ScanMessage& message) {
  CdrWriter to{96 + sizeof(float) * message.ranges.size()};
  const double last = static_cast<double>(message.ranges.size()) - 1.0;
  put_header(to, message.stamp, message.frame);
  to.put(static_cast<float>(message.angle_min),
         static_cast<float>(message.angle_min + last * message.angle_increment),
         static_cast<float>(message.angle_increment), 0.0F, static_cast<float>(message.scan_time),
         static_cast<float>(message.range_min), static_cast<float>(message.range_max));
  to.count(message.ranges.size());
  for (const float range : message.ranges) to.put(range);
  to.count(0);
  return to.bytes();
}

std::string encode(const TransformMessage& message) {
  CdrWriter to{160};
  to.count(1);
  put_header(to, message.stamp, message.frame).text(message.child_frame);
  put_pose(to, message.pose);
  return to.bytes();
}

std::optional<std::vector<TransformMessage>> decode_transforms(std::string_view bytes) {
  constexpr std::size_t kSmallestTransform = 72;
  CdrSource from(bytes);
  std::vector<TransformMessage> transforms;
  for (std::uint32_t i = from.count(kSmallestTransform); i > 0 && from.ok(); --i) {
    TransformMessage transform;
    get_header(from, transform);
    transform.child_frame = from.text();
    transform.pose = get_pose(from);
    transforms.push_back(std::move(transform));
  }
  return checked(from, std::move(transforms));
}

std::string encode(const StopMessage& message) {
  const auto size = static_cast<std::size_t>(message.stop.size);
  CdrWriter to{64 + 5 * (8 + sizeof(double) * size)};
  to.stamp_ns(message.stamp);
  const auto column = [&](auto&& value_of) {
    to.count(size);
    for (std::size_t i = 0; i < size; ++i) to.put(value_of(message.stop.points[i]));
  };
  column([](const safety::StopPoint& point) { return point.time; });
  column([](const safety::StopPoint& point) { return point.distance; });
  column([](const safety::StopPoint& point) { return point.speed; });
  column([](const safety::StopPoint& point) { return point.command.steer; });
  column([](const safety::StopPoint& point) { return point.command.throttle; });
  return to.bytes();
}

std::optional<StopMessage> decode_stop(std::string_view bytes) {
  CdrSource from(bytes);
  StopMessage message;
  message.stamp = from.stamp();
  safety::StopPlan& stop = message.stop;
  bool is_sound = true;
  const auto column = [&](auto&& place_of) {
    const std::uint32_t size = from.count(sizeof(double));
    if (size > safety::StopPlan::kCapacity) return void(is_sound = false);
    if (stop.size == 0) stop.size = static_cast<int>(size);
    is_sound = is_sound && static_cast<int>(size) == stop.size;
    for (std::uint32_t i = 0; i < size; ++i) {
      const double value = from.number();
      is_sound = is_sound && std::isfinite(value);
      place_of(stop.points[i]) = value;
    }
  };
  column([](safety::StopPoint& point) -> double& { return point.time; });
  column([](safety::StopPoint& point) -> double& { return point.distance; });
  column([](safety::StopPoint& point) -> double& { return point.speed; });
  column([](safety::StopPoint& point) -> double& { return point.command.steer; });
  column([](safety::StopPoint& point) -> double& { return point.command.throttle; });
  for (std::size_t i = 1; is_sound && i < static_cast<std::size_t>(stop.size); ++i)
    is_sound = stop.points[i].time >= stop.points[i - 1].time;
  if (!is_sound) return std::nullopt;
  return checked(from, std::move(message));
}

std::string encode_clock(std::int64_t time) { return CdrWriter{16}.stamp_ns(time).bytes(); }

std::optional<std::int64_t> decode_clock(std::string_view bytes) {
  CdrSource from(bytes);
  const std::int64_t time = from.stamp();
  return from.ok() ? std::optional(time) : std::nullopt;
}

std::string encode_bool(bool value) { return CdrWriter{16}.put(value).bytes(); }

std::optional<bool> decode_bool(std::string_view bytes) {
  CdrSource from(bytes);
  const bool value = from.flag();
  return from.ok() ? std::optional(value) : std::nullopt;
}

}  // namespace chicane::protocol
