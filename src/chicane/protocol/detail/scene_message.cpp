// SPDX-License-Identifier: MIT
#include "chicane/protocol/detail/scene_message.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "chicane/protocol/detail/cdr_writer.hpp"

namespace chicane::protocol {
namespace {

struct Colour {
  double r, g, b;
};
constexpr Colour kAsphalt{0.33, 0.35, 0.39}, kPaint{0.92, 0.93, 0.95}, kBody{0.15, 0.39, 0.85},
    kCabin{0.11, 0.13, 0.17}, kTire{0.07, 0.07, 0.08};
constexpr double kLineWidth = 0.25;    // [m]
constexpr double kPaintHeight = 0.02;  // above the road [m]

struct Cube {
  double x, y, z;                // of its middle
  double length, width, height;  // [m]
  Colour colour;
};

void put_colour(CdrWriter& writer, Colour colour) { writer.put(colour.r, colour.g, colour.b, 1.0); }

void put_points(CdrWriter& writer, const std::vector<Vec2>& points, double height) {
  writer.count(points.size());
  for (const Vec2& point : points) writer.put(point.x(), point.y(), height);
}

/// Until the arrays of primitives: arrows, cubes, spheres, cylinders, lines, triangles, texts, models.
void begin_entity(CdrWriter& writer, std::string_view frame_id, std::string_view id, bool is_locked) {
  writer.stamp(0.0).text(frame_id).text(id);
  writer.put(std::int32_t{0}, std::uint32_t{0}, is_locked).count(0);  // for ever, no metadata
}

void put_empty(CdrWriter& writer, int arrays) {
  for (int i = 0; i < arrays; ++i) writer.count(0);
}

void put_line(CdrWriter& writer, const std::vector<Vec2>& points) {
  writer.put(std::uint8_t{0}, 0.0, 0.0, 0.0).orientation(0.0).put(kLineWidth, false);  // a strip
  put_points(writer, points, kPaintHeight);
  put_colour(writer, kPaint);
  put_empty(writer, 2);  // colours, indices
}

/// The surface between the edges: two triangles for each pair of neighbours.
void put_surface(CdrWriter& writer, const RoadLines& road) {
  const std::size_t pairs = std::min(road.left.size(), road.right.size());
  writer.put(0.0, 0.0, 0.0).orientation(0.0);
  writer.count(2 * pairs);
  for (std::size_t i = 0; i < pairs; ++i)
    writer.put(road.left[i].x(), road.left[i].y(), 0.0, road.right[i].x(), road.right[i].y(), 0.0);
  put_colour(writer, kAsphalt);
  writer.count(0).count(pairs == 0 ? 0 : 6 * (pairs - 1));
  for (std::uint32_t i = 0; i + 1 < pairs; ++i) {
    const std::uint32_t at = 2 * i;
    writer.put(at, at + 1, at + 2, at + 1, at + 3, at + 2);
  }
}

void put_road(CdrWriter& writer, const RoadLines& road) {
  begin_entity(writer, "map", "road", false);
  put_empty(writer, 4);
  writer.count(2);
  put_line(writer, road.left);
  put_line(writer, road.right);
  writer.count(1);
  put_surface(writer, road);
  put_empty(writer, 2);
}

std::vector<Cube> parts_of(const model::VehicleParams& car) {
  const double wheelbase = car.front_axle + car.rear_axle;
  const double wheel = 0.24 * wheelbase, low = 0.12 * wheelbase, tall = 0.2 * wheelbase;
  std::vector<Cube> parts{
      {0.5 * wheelbase, 0.0, low + 0.5 * tall, car.length, 0.92 * car.width, tall, kBody},
      {0.4 * wheelbase, 0.0, low + 1.4 * tall, 0.42 * car.length, 0.75 * car.width, 0.8 * tall, kCabin}};
  for (const double x : {0.0, wheelbase}) {
    for (const double side : {-0.5, 0.5})
      parts.push_back({x, side * car.track_width, 0.5 * wheel, wheel, car.tire_width, wheel, kTire});
  }
  return parts;
}

void put_car(CdrWriter& writer, const model::VehicleParams& car) {
  begin_entity(writer, "base_link", "car", true);
  const std::vector<Cube> parts = parts_of(car);
  put_empty(writer, 1);
  writer.count(parts.size());
  for (const Cube& part : parts) {
    writer.put(part.x, part.y, part.z).orientation(0.0).put(part.length, part.width, part.height);
    put_colour(writer, part.colour);
  }
  put_empty(writer, 6);
}

}  // namespace

std::string encode_scene(const telemetry::Frame& /*frame*/, const Run& run) {
  const std::size_t points = run.road.left.size() + run.road.right.size();
  CdrWriter writer{4096 + 80 * points};
  writer.count(0).count(2);  // deletions, entities
  put_road(writer, run.road);
  put_car(writer, run.vehicle);
  return writer.bytes();
}

}  // namespace chicane::protocol
