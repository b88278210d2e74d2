// SPDX-License-Identifier: MIT
#include "chicane/base/option.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

enum class Colour { kRed, kGreen };
struct Inner {
  double rate = kInfinity;
};
struct Sample {
  double delay = 0.1;
  double angle = 0.2;
  int count = 3;
  std::uint64_t seed = 1;
  bool is_on = true;
  std::string name = "one";
  std::string shape = "round";
  Colour colour = Colour::kGreen;
  Inner inner;
};

constexpr std::array<std::string_view, 2> kColours{"red", "green"};
constexpr std::array<std::string_view, 2> kShapes{"round", "square"};
constexpr std::array kOptions{
    option<&Sample::delay>("delay", unit::kMillisecond, 0, 500, "How late."),
    option<&Sample::angle>("angle", unit::kDegree, 0.1, 80, "How far."),
    option<&Sample::count>("count", unit::kNone, 2, 200, "How many."),
    option<&Sample::seed>("seed", unit::kNone, 0, 9007199254740992.0, "Of chance."),
    option<&Sample::is_on>("is_on", "Whether."),
    option<&Sample::name>("name", "Which."),
    option<&Sample::shape>("shape", kShapes, "What form."),
    option<&Sample::colour>("colour", kColours, "What colour."),
    option<&Sample::inner, &Inner::rate>("rate", unit::per("1/s"), 1, 10, "How fast.").or_infinite(),
};
const Option& row(std::string_view name) {
  for (const Option& each : kOptions) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(std::string(name));
}

std::string error_of(std::string_view name, const OptionValue& value) {
  Sample sample;
  return test::refusal_of(set(row(name), option_key("sample", row(name)), &sample, value));
}

TEST(Option, KeysHaveTheGroupAndEndWithTheUnit) {
  EXPECT_EQ(option_key("sample", row("delay")), "sample.delay_ms");
  EXPECT_EQ(option_key("", row("delay")), "delay_ms");
  EXPECT_EQ(option_key("sample", row("rate")), "sample.rate");
}

TEST(Option, ReadsEveryKindOfFieldInItsUnit) {
  const Sample sample;
  EXPECT_EQ(get(row("delay"), &sample), OptionValue(100.0));
  EXPECT_EQ(get(row("count"), &sample), OptionValue(3.0));
  EXPECT_EQ(get(row("seed"), &sample), OptionValue(1.0));
  EXPECT_EQ(get(row("is_on"), &sample), OptionValue(true));
  EXPECT_EQ(get(row("name"), &sample), OptionValue(std::string("one")));
  EXPECT_EQ(get(row("shape"), &sample), OptionValue(std::string("round")));
  EXPECT_EQ(get(row("colour"), &sample), OptionValue(std::string("green")));
  EXPECT_EQ(get(row("rate"), &sample), OptionValue(kInfinity));
}

TEST(Option, WritesEveryKindOfFieldInSi) {
  Sample sample;
  const auto write = [&](std::string_view name, const OptionValue& value) {
    EXPECT_EQ(test::refusal_of(set(row(name), name, &sample, value)), "");
  };
  write("delay", 40.0);
  write("angle", 25.0);
  write("count", 7.0);
  write("seed", 9007199254740992.0);
  write("is_on", false);
  write("name", std::string("two"));
  write("shape", std::string("square"));
  write("colour", std::string("red"));
  write("rate", 5.0);
  EXPECT_EQ(sample.delay, 0.04);
  EXPECT_EQ(sample.angle, 0.4363323129985824);
  EXPECT_EQ(sample.count, 7);
  EXPECT_EQ(sample.seed, 9007199254740992U);
  EXPECT_FALSE(sample.is_on);
  EXPECT_EQ(sample.name, "two");
  EXPECT_EQ(sample.shape, "square");
  EXPECT_EQ(sample.colour, Colour::kRed);
  EXPECT_EQ(sample.inner.rate, 5.0);
}

TEST(Option, RefusesWhatIsOutOfRangeOrOfAnotherType) {
  EXPECT_EQ(error_of("delay", 900.0), "sample.delay_ms: got 900, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("delay", kNaN), "sample.delay_ms: got nan, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("delay", kInfinity), "sample.delay_ms: got inf, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("delay", true), "sample.delay_ms: got true, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("count", 2.5), "sample.count: got 2.5, expected an integer in [2, 200]");
  EXPECT_EQ(error_of("rate", 0.5), "sample.rate: got 0.5, expected a number in [1, 10] 1/s or inf");
  EXPECT_EQ(error_of("rate", -kInfinity), "sample.rate: got -inf, expected a number in [1, 10] 1/s or inf");
  EXPECT_EQ(error_of("is_on", 1.0), "sample.is_on: got 1, expected true or false");
  EXPECT_EQ(error_of("is_on", std::string("yes")), "sample.is_on: got yes, expected true or false");
  EXPECT_EQ(error_of("name", std::string()), "sample.name: got nothing, expected text");
  EXPECT_EQ(error_of("name", 1.0), "sample.name: got 1, expected text");
  EXPECT_EQ(error_of("shape", std::string("flat")), "sample.shape: got flat, expected one of round, square");
  EXPECT_EQ(error_of("colour", std::string("blue")), "sample.colour: got blue, expected one of red, green");
  EXPECT_EQ(error_of("colour", 1.0), "sample.colour: got 1, expected one of red, green");
}

TEST(Option, ARefusedValueChangesNothing) {
  Sample sample;
  EXPECT_FALSE(set(row("delay"), "delay", &sample, 900.0));
  EXPECT_FALSE(set(row("colour"), "colour", &sample, std::string("blue")));
  EXPECT_EQ(sample.delay, 0.1);
  EXPECT_EQ(sample.colour, Colour::kGreen);
}

TEST(Option, ChecksAWholeStructByTheSameRows) {
  const auto error = [](auto change) {
    Sample sample;
    change(sample);
    return test::refusal_of(check_options("sample", kOptions, &sample));
  };
  EXPECT_EQ(error([](Sample&) {}), "");
  EXPECT_EQ(error([](Sample& s) { s.delay = 0.6; }),
            "sample.delay_ms: got 600, expected a number in [0, 500] ms");
  EXPECT_EQ(error([](Sample& s) { s.delay = kNaN; }),
            "sample.delay_ms: got nan, expected a number in [0, 500] ms");
  EXPECT_EQ(error([](Sample& s) { s.count = 1; }), "sample.count: got 1, expected an integer in [2, 200]");
  EXPECT_EQ(error([](Sample& s) { s.inner.rate = 11.0; }),
            "sample.rate: got 11, expected a number in [1, 10] 1/s or inf");
  EXPECT_EQ(error([](Sample& s) { s.shape = "flat"; }),
            "sample.shape: got flat, expected one of round, square");
  EXPECT_EQ(error([](Sample& s) { s.colour = static_cast<Colour>(2); }),
            "sample.colour: got 2, expected one of red, green");
}

TEST(Option, WhatSetAcceptsPassesTheCheck) {
  Sample sample;
  for (double degrees = 0.1; degrees < 80.0; degrees += 0.01) {
    ASSERT_TRUE(set(row("angle"), "angle", &sample, degrees));
    ASSERT_TRUE(check_options("sample", kOptions, &sample)) << degrees;
  }
  ASSERT_TRUE(set(row("angle"), "angle", &sample, 80.0));
  ASSERT_TRUE(check_options("sample", kOptions, &sample));
}

TEST(Within, TakesTheRoundingOfFloatsForTheBorder) {
  EXPECT_EQ(within(-1e-7, 0.0, 1000.0), 0.0);
  EXPECT_EQ(within(1.0000001, -1.0, 1.0), 1.0);
  EXPECT_EQ(within(static_cast<double>(1000.00006F), 0.0, 1000.0), 1000.0) << "the next float";
  EXPECT_EQ(within(0.3, -1.0, 1.0), 0.3);
}

TEST(Within, RefusesWhatIsOutside) {
  EXPECT_FALSE(within(-0.01, 0.0, 1000.0)) << "a real negative speed";
  EXPECT_FALSE(within(1.00001, -1.0, 1.0));
  EXPECT_FALSE(within(std::numeric_limits<double>::quiet_NaN(), -1.0, 1.0));
  EXPECT_FALSE(within(std::numeric_limits<double>::infinity(), -1.0, 1.0));
}

}  // namespace
}  // namespace chicane
