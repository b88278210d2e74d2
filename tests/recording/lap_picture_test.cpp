// SPDX-License-Identifier: MIT
#include "chicane/recording/lap_picture.hpp"

#include "chicane/recording/detail/canvas.hpp"
#include "support/chicane_test.hpp"

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

}  // namespace
}  // namespace chicane::recording
