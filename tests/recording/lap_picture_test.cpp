// SPDX-License-Identifier: MIT
#include "chicane/recording/lap_picture.hpp"

#include "chicane/recording/detail/canvas.hpp"
#include "chicane/recording/detail/ros_message.hpp"
#include "recording/recorded_run.hpp"
#include "support/chicane_test.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

constexpr Colour kWhite{255, 255, 255};

int red_at(const Canvas& canvas, int x, int y) {
  return canvas.bytes()[static_cast<std::size_t>(3 * (y * canvas.width() + x))];
}

/// Of all pixels, in pixels: what white shapes cover.
double white_area(const Canvas& canvas) {
  double sum = 0.0;
  for (std::size_t i = 0; i < canvas.bytes().size(); i += 3) sum += canvas.bytes()[i] / 255.0;
  return sum;
}

TEST(Canvas, CoversPixelsByTheirShare) {
  Canvas canvas(40, 30);
  canvas.rectangle(10.0, 10.0, 5.5, 4.25, kWhite);
  EXPECT_EQ(red_at(canvas, 10, 10), 255);
  EXPECT_EQ(red_at(canvas, 9, 10), 0);
  EXPECT_NEAR(red_at(canvas, 15, 11), 128, 1);
  EXPECT_NEAR(red_at(canvas, 12, 14), 64, 1);
  EXPECT_NEAR(white_area(canvas), 5.5 * 4.25, 0.1);
}

TEST(Canvas, SlantedShapesHaveTheirArea) {
  Canvas canvas(100, 100);
  canvas.fill({{{10.3, 20.7}, {80.1, 33.2}, {40.6, 90.9}}}, kWhite);
  const double area = 0.5 * std::fabs(69.8 * 70.2 - 30.3 * 12.5);
  EXPECT_NEAR(white_area(canvas), area, 0.005 * area);
  Canvas flat(100, 100);
  flat.disc({50.0, 50.0}, 20.0, kWhite);
  EXPECT_NEAR(white_area(flat), 3.14159 * 400.0, 20.0);
}

TEST(Canvas, ARingTurnedAgainstAnotherIsAHole) {
  Canvas canvas(60, 60);
  canvas.fill({{{5, 5}, {55, 5}, {55, 55}, {5, 55}}, {{20, 20}, {20, 40}, {40, 40}, {40, 20}}}, kWhite);
  EXPECT_EQ(red_at(canvas, 10, 30), 255);
  EXPECT_EQ(red_at(canvas, 30, 30), 0);
  EXPECT_NEAR(white_area(canvas), 2500.0 - 400.0, 0.5);
}

TEST(Canvas, WhatLiesOutsideIsLeftOut) {
  Canvas canvas(20, 20);
  canvas.rectangle(-1e6, -50.0, 1e6 + 5.0, 60.0, kWhite);
  EXPECT_EQ(red_at(canvas, 4, 9), 255);
  EXPECT_EQ(red_at(canvas, 5, 9), 0);
  EXPECT_EQ(red_at(canvas, 4, 10), 0);
  canvas.clear({});
  canvas.rectangle(100.0, 0.0, 5.0, 5.0, kWhite);
  canvas.line(std::vector<Vec2>{{-10, 500}, {900, 700}}, 3.0, kWhite);
  canvas.fill({{{std::numeric_limits<double>::quiet_NaN(), 0.0},
                {1.0, 1.0},
                {2.0, std::numeric_limits<double>::infinity()}}},
              kWhite);
  EXPECT_LT(white_area(canvas), 20.0);
}

TEST(Canvas, TextHasItsWidthAndEveryLetterAShape) {
  Canvas canvas(400, 40);
  const double end = canvas.text(10.0, 30.0, 16.0, "lap 1", kWhite);
  EXPECT_DOUBLE_EQ(end, 10.0 + Canvas::text_width(16.0, "lap 1"));
  EXPECT_GT(white_area(canvas), 50.0);
  for (const char letter : std::string("0123456789abcdefghijklmnopqrstuvwxyzABCZ.:+-/%()_,")) {
    int strokes = 0;
    for_each_stroke(letter, [&](double x0, double y0, double x1, double y1) {
      ++strokes;
      for (const double value : {x0, y0, x1, y1}) EXPECT_TRUE(value >= 0.0 && value <= 1.0) << letter;
    });
    EXPECT_GT(strokes, 0) << letter;
  }
}

/// A straight road of 300 m, and a car that drives on it from left to right.
DrivenRun straight_run() {
  DrivenRun run;
  run.track = "straight";
  run.track_length = 300.0;
  run.is_closed = false;
  for (int i = 0; i <= 30; ++i) {
    run.left.emplace_back(10.0 * i, 4.0);
    run.right.emplace_back(10.0 * i, -4.0);
  }
  return run;
}

std::vector<DrivenMoment> drive(double speed, double begin) {
  std::vector<DrivenMoment> moments;
  for (int i = 0; i <= 100; ++i) {
    DrivenMoment moment;
    moment.time = begin + 0.1 * i;
    moment.s = 10.0 + speed * 0.1 * i;
    moment.position = {moment.s, 0.0};
    moment.speed = speed;
    moment.plan = {moment.position, moment.position + Vec2{20.0, 0.0}};
    moment.plan_speed = {speed, speed};
    moments.push_back(moment);
  }
  return moments;
}

TEST(LapPicture, TellsTheTimeLostToTheGhostAtTheSamePlace) {
  const DrivenRun run = straight_run();
  LapPicture picture(run, drive(20.0, 5.0), drive(25.0, 70.0), {.width = 320, .height = 180});
  EXPECT_NEAR(picture.duration(), 10.0, 1e-9);
  const auto lost = test::good(picture.lost_to_ghost(5.0));
  EXPECT_NEAR(*lost, 1.0, 1e-9) << "100 m take 5 s and 4 s";
  EXPECT_FALSE(LapPicture(run, drive(20.0, 0.0), {}, {}).lost_to_ghost(5.0));
  EXPECT_FALSE(LapPicture(run, drive(25.0, 0.0), drive(20.0, 0.0), {}).lost_to_ghost(9.9))
      << "the ghost has not been there";
}

TEST(LapPicture, DrawsRoadCarGhostAndPlan) {
  const DrivenRun run = straight_run();
  const PictureOptions options{.width = 320, .height = 180, .view = 80.0};
  LapPicture alone(run, drive(20.0, 0.0), {}, options);
  const std::vector<std::uint8_t> first(alone.at(3.0).bytes().begin(), alone.at(3.0).bytes().end());
  const std::vector<std::uint8_t> again(alone.at(3.0).bytes().begin(), alone.at(3.0).bytes().end());
  EXPECT_EQ(first, again);
  LapPicture with_ghost(run, drive(20.0, 0.0), drive(25.0, 0.0), options);
  const std::vector<std::uint8_t> ghost(with_ghost.at(3.0).bytes().begin(), with_ghost.at(3.0).bytes().end());
  EXPECT_NE(first, ghost);
  // The camera looks 0.16 views ahead: the car stands so far left of the middle, and is orange.
  const int x = 160 - static_cast<int>(0.16 * 80.0 * 4.0) - 3, y = 99;
  const auto* pixel = &first[static_cast<std::size_t>(3 * (y * 320 + x))];
  EXPECT_GT(pixel[0], 200);
  EXPECT_LT(pixel[2], 100);
}

TEST(LapPicture, KeepsToItsEndsAndBearsARunWithoutARoad) {
  DrivenRun run;
  LapPicture picture(run, drive(20.0, 0.0), {}, {.width = 160, .height = 90, .shows_whole = true});
  const std::vector<std::uint8_t> last(picture.at(10.0).bytes().begin(), picture.at(10.0).bytes().end());
  const std::vector<std::uint8_t> later(picture.at(99.0).bytes().begin(), picture.at(99.0).bytes().end());
  EXPECT_EQ(last, later);
  LapPicture empty(run, {}, {}, {.width = 160, .height = 90});
  EXPECT_EQ(empty.duration(), 0.0);
  EXPECT_EQ(empty.at(1.0).width(), 160);
}

using telemetry::TemporaryFile;

TEST(DrivenRun, HoldsWhatWasRecorded) {
  const TemporaryFile file;
  const std::vector<telemetry::Frame> frames = record_run(file.path(), "oval", "1");
  const auto run = test::good(read_run(file.path()));
  EXPECT_EQ(run->track, "oval");
  EXPECT_GT(run->left.size(), 100U);
  EXPECT_EQ(run->left.size(), run->right.size());
  EXPECT_EQ(run->last_lap, 1);
  ASSERT_EQ(run->moments.size(), frames.size());
  const telemetry::Frame& frame = frames[200];
  const DrivenMoment& moment = run->moments[200];
  EXPECT_DOUBLE_EQ(moment.time, frame.time);
  EXPECT_DOUBLE_EQ(moment.position.x(), frame.truth.x);
  EXPECT_DOUBLE_EQ(moment.heading, frame.truth.psi);
  EXPECT_DOUBLE_EQ(moment.steer, frame.result.command.steer);
  EXPECT_DOUBLE_EQ(moment.s, frame.s);
  ASSERT_EQ(moment.plan.size(), static_cast<std::size_t>(frame.result.plan.size));
  EXPECT_DOUBLE_EQ(moment.plan[3].y(), frame.result.plan.points[3].y);
  EXPECT_EQ(run->of_lap(1).size(), frames.size());
  EXPECT_EQ(run->of_lap(0).size(), frames.size());
  EXPECT_TRUE(run->of_lap(2).empty());
}

TEST(DrivenRun, SaysWhatIsNoRecording) {
  EXPECT_FALSE(read_run("nowhere.mcap"));
  const auto read = read_run(CHICANE_SOURCE_DIR "/README.md");
  ASSERT_FALSE(read);
}

TEST(RosReader, ReadsNestedMessagesArraysAndTexts) {
  const auto reader = test::good(RosReader::create(
      "# a comment\nuint8 KIND=3\nbool flag\nfloat64 x # with unit\na_msgs/Point[] points\nstring name\n"
      "float64[2] pair\n================\nMSG: a_msgs/Point\nint32 i\nfloat64 y\n"));
  std::string bytes{"\0\1\0\0", 4};
  const auto add = [&](auto value, std::size_t padding) {
    bytes.append(padding, '\0');
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(std::uint8_t{1}, 0);
  add(2.5, 7);
  add(std::uint32_t{2}, 0);
  add(std::int32_t{-1}, 0);
  add(7.0, 0);
  add(std::int32_t{5}, 0);
  add(8.0, 4);
  add(std::uint32_t{3}, 0);
  bytes.append("hi\0", 3);
  add(1.0, 1);
  add(2.0, 0);
  const auto content = test::good(reader->read(bytes));
  EXPECT_EQ(content->number("flag"), 1.0);
  EXPECT_EQ(content->number("x"), 2.5);
  EXPECT_THAT(content->list("points.i"), ElementsAre(-1.0, 5.0));
  EXPECT_THAT(content->list("points.y"), ElementsAre(7.0, 8.0));
  EXPECT_EQ(content->text("name"), "hi");
  EXPECT_THAT(content->list("pair"), ElementsAre(1.0, 2.0));
  EXPECT_EQ(content->number("nothing", -7.0), -7.0);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(reader->read(std::string_view(bytes).substr(0, size))) << size;
}

TEST(RosReader, RefusesDefinitionsWithHolesAndCountsBeyondReason) {
  EXPECT_THAT(test::refusal_of(RosReader::create("b_msgs/Missing[] all\n")), HasSubstr("b_msgs/Missing"));
  const auto reader = test::good(RosReader::create("float64[] x\n"));
  EXPECT_FALSE(reader->read(std::string("\0\1\0\0\xff\xff\xff\xff", 8)));
  const auto endless = test::good(RosReader::create("c_msgs/A a\n===\nMSG: c_msgs/A\nc_msgs/A a\n"));
  EXPECT_FALSE(endless->read(std::string("\0\1\0\0", 4))) << "a message within itself ends somewhere";
}

}  // namespace
}  // namespace chicane::recording
