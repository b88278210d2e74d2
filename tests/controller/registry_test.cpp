// SPDX-License-Identifier: MIT
#include "chicane/controller/registry.hpp"
#include "support/chicane_test.hpp"

#include <cctype>

namespace chicane::controller {
namespace {

const model::VehicleParams kCar;
constexpr double kMostSpeed = 230.0 * 0.44704;  // [m/s]

/// A controller that is in no list but this test's.
struct ScratchOptions {
  double steady_steer = 0.1;
  bool is_bold = false;
};

class Scratch final : public Controller, public Tunable<ScratchOptions> {
 public:
  explicit Scratch(const ScratchOptions& options) { result_.command.steer = options.steady_steer; }
  const StepResult& step(const model::Measurement& /*now*/, Deadline /*deadline*/) noexcept override {
    return result_;
  }
  void configure(const ScratchOptions& options, const model::VehicleParams& /*car*/) noexcept override {
    result_.command.steer = options.steady_steer;
  }
  void reset() noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "from-scratch"; }

 private:
  StepResult result_;
};

Result<std::unique_ptr<Controller>> make_scratch(const ScratchOptions& options,
                                                 const model::VehicleParams& vehicle);

constexpr std::array kScratchOptions{
    option<&ScratchOptions::steady_steer>("steady_steer", unit::kDegree, -10, 10, "The angle it holds."),
    option<&ScratchOptions::is_bold>("is_bold", "Whether it dares."),
};
struct ScratchEntry {
  using Options = ScratchOptions;
  static constexpr std::string_view kName = "from-scratch";
  static constexpr std::string_view kMeaning = "holds the wheel";
  static std::span<const Option> options() noexcept { return kScratchOptions; }
  static constexpr auto kMake = &make_scratch;
  static std::vector<OptionContradiction> contradictions(const ScratchOptions& options) {
    if (options.is_bold && options.steady_steer == 0.0) return {{"is_bold", "got true, expected false"}};
    return {};
  }
};

Result<std::unique_ptr<Controller>> make_scratch(const ScratchOptions& options,
                                                 const model::VehicleParams& vehicle) {
  if (const auto valid = check<ScratchEntry>(options, vehicle); !valid) return fail(valid.error());
  return std::make_unique<Scratch>(options);
}

using List = ControllerList<PidEntry, ScratchEntry>;

double steer_of(Controller& controller) { return controller.step({}, Deadline::never()).command.steer; }

TEST(ControllerList, KnowsAnEntryByItsNameAndItsOptionsByTheirGroup) {
  const List::Kind* kind = List::find("from-scratch");
  ASSERT_NE(kind, nullptr);
  EXPECT_EQ(kind->group, "from_scratch");
  EXPECT_EQ(kind->meaning, "holds the wheel");
  EXPECT_EQ(List::find("from_scratch"), nullptr);
  EXPECT_THAT(List::kNames, ElementsAre("pid", "from-scratch"));
}

TEST(ControllerList, MakesAControllerWithItsOwnOptions) {
  List::Options options;
  std::get<ScratchOptions>(options).steady_steer = 0.05;
  const auto scratch = test::good(List::make("from-scratch", options, kCar));
  EXPECT_EQ(steer_of(**scratch), 0.05);
}

TEST(ControllerList, RefusesAnUnknownNameAndAnOptionOutOfRange) {
  List::Options options;
  EXPECT_EQ(List::make("mpc", options, kCar).error().message,
            "controller: got mpc, expected one of pid, from-scratch");
  std::get<ScratchOptions>(options).steady_steer = degrees_to_radians(20.0);
  EXPECT_EQ(List::make("from-scratch", options, kCar).error().message,
            "from_scratch.steady_steer_deg: got 20, expected a number in [-10, 10] deg");
  EXPECT_TRUE(List::make("pid", options, kCar)) << "of another controller";
}

TEST(ControllerList, GivesEachControllerItsOwnOptionsWhileItDrives) {
  List::Options options;
  const auto scratch = std::move(*List::make("from-scratch", options, kCar));
  std::get<ScratchOptions>(options).steady_steer = -0.07;
  List::configure(*scratch, options, kCar);
  EXPECT_EQ(steer_of(*scratch), -0.07);
}

TEST(ControllerList, AsksTheEntryForContradictions) {
  List::Options options;
  const List::Kind& kind = *List::find("from-scratch");
  EXPECT_TRUE(kind.contradictions(options).empty());
  std::get<ScratchOptions>(options) = {.steady_steer = 0.0, .is_bold = true};
  ASSERT_EQ(kind.contradictions(options).size(), 1U);
  EXPECT_EQ(kind.contradictions(options)[0].option, "is_bold");
  EXPECT_TRUE(List::find("pid")->contradictions(options).empty());
}

TEST(Registry, MakesEveryControllerUnderItsNameAndForASoundCar) {
  model::VehicleParams broken;
  broken.mass = -1.0;
  std::set<std::string_view> groups;
  for (const Registry::Kind& kind : Registry::kinds()) {
    const auto controller = Registry::make(kind.name, {}, kCar);
    ASSERT_TRUE(controller) << controller.error().message;
    EXPECT_EQ((*controller)->name(), kind.name);
    EXPECT_FALSE(Registry::make(kind.name, {}, broken)) << kind.name;
    EXPECT_TRUE(groups.insert(kind.group).second) << kind.group;
    for (const char c : kind.name) EXPECT_TRUE(c == '-' || std::islower(c) != 0) << kind.name;
  }
}

TEST(Registry, EveryControllerRefusesEachOptionBeyondItsRowsRange) {
  Registry::for_each([]<class Entry>() {
    for (const Option& row : Entry::options()) {
      if (row.kind != OptionKind::kNumber && row.kind != OptionKind::kInteger) continue;
      for (const double beyond : {row.minimum - 1.0, row.maximum + 1.0}) {
        Registry::Options options;
        row.write(&std::get<typename Entry::Options>(options), row.unit.to_si(beyond));
        const auto made = Registry::make(Entry::kName, options, kCar);
        ASSERT_FALSE(made) << row.name;
        EXPECT_THAT(made.error().message, StartsWith(option_key(kOptionGroup<Entry>, row) + ": got "));
      }
    }
  });
}

TEST(Registry, WhatSetsTheSpeedIsAnOptionOfTheControllerUpTo230MilesPerHour) {
  EXPECT_EQ(List::find("from-scratch")->speed_option, "");
  Registry::for_each([]<class Entry>() {
    const std::string_view speed = Registry::find(Entry::kName)->speed_option;
    bool is_known = speed.empty();
    for (const Option& row : Entry::options()) {
      if (row.name != speed) continue;
      is_known = true;
      EXPECT_GE(row.maximum, kMostSpeed) << Entry::kName;
    }
    EXPECT_TRUE(is_known) << Entry::kName;
  });
}

}  // namespace
}  // namespace chicane::controller
