// SPDX-License-Identifier: MIT
#include "chicane/run/plan_cache.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"
#include "support/roads.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

road::Track ring(double radius = 60.0, double half_width = 4.0) {
  std::vector<Vec2> line = test::circle_points(radius, 60);
  for (Vec2& point : line) point.y() *= 0.7;
  return *road::Track::create("ring", test::with_widths(line, half_width, half_width), true);
}

/// A cache of this process for one test.
class PlanCacheTest : public testing::Test, protected test::Folder {
 protected:
  PlanCacheTest() {
    std::filesystem::remove_all(folder_);  // the cache makes it
    cache_ = std::make_shared<DiskCache>(folder_.string(),
                                         [this](std::string_view line) { said_.emplace_back(line); });
    use_plan_cache(cache_);
  }
  ~PlanCacheTest() override { use_plan_cache(nullptr); }

  /// Iterations that it took.
  int plan(road::RacingLine& line, lap_time::RacingPlanOptions options = {.time_step = 0.12}) {
    int iterations = 0;
    options.go_on = [&](int, double) { return ++iterations > 0; };
    line = cached_plan(ring(), model::udacity_params(), options).value();
    return iterations;
  }

  std::shared_ptr<const DiskCache> cache_;
  std::vector<std::string> said_;
};

TEST_F(PlanCacheTest, ACachedPlanHasTheBitsOfAFreshOne) {
  road::RacingLine fresh, cached, again;
  EXPECT_GT(plan(fresh), 0);
  EXPECT_EQ(plan(cached), 0);
  EXPECT_EQ(to_bytes(cached), to_bytes(fresh));
  use_plan_cache(nullptr);
  EXPECT_GT(plan(again), 0);
  EXPECT_EQ(to_bytes(again), to_bytes(cached));
}

TEST_F(PlanCacheTest, ADamagedPlanIsPlannedAnewWithOneLine) {
  road::RacingLine fresh, anew;
  plan(fresh);
  const std::string name = name_of_plan(ring(), model::udacity_params(), {.time_step = 0.12});
  cache_->keep(name, "whole, and no plan");
  EXPECT_GT(plan(anew), 0);
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_EQ(to_bytes(anew), to_bytes(fresh));
  EXPECT_EQ(plan(anew), 0) << "and kept";
}

TEST_F(PlanCacheTest, TheNameTellsAllThatAPlanDependsOn) {
  const road::Track road = ring();
  const model::VehicleParams car = model::udacity_params();
  const std::string name = name_of_plan(road, car, {});
  ASSERT_EQ(name.size(), 32U) << "this program has no build id";
  EXPECT_EQ(name, name_of_plan(ring(), car, {}));
  EXPECT_NE(name, name_of_plan(ring(60.001), car, {}));
  EXPECT_NE(name, name_of_plan(ring(60.0, 4.001), car, {}));
  for (const Option& option : model::vehicle_options()) {
    if (option.kind != OptionKind::kNumber) continue;
    model::VehicleParams other = car;
    option.write(&other, std::get<double>(option.read(&other)) == 0.5 ? 0.25 : 0.5);
    EXPECT_NE(name, name_of_plan(road, other, {})) << option.name;
  }
  for (const lap_time::RacingPlanOptions& other : {lap_time::RacingPlanOptions{.margin = 0.1},
                                                   {.grip_share = 0.9},
                                                   {.slip_share = 0.9},
                                                   {.brake_share = 0.9},
                                                   {.speed_limit = 50.0},
                                                   {.time_step = 0.1},
                                                   {.budget = 10.0}})
    EXPECT_NE(name, name_of_plan(road, car, other));
  EXPECT_NE(name, name_of_limit(road, "udacity", {}, {}, {}));
  EXPECT_NE(name_of_limit(road, "udacity", {}, {}, {}), name_of_limit(road, "road-car", {}, {}, {}));
  EXPECT_NE(name_of_limit(road, "udacity", {}, {}, {}),
            name_of_limit(road, "udacity", {.friction_scale = 0.9}, {}, {}));
}

TEST_F(PlanCacheTest, AWholeLimitAnswersWhateverNeedsNoMoreWork) {
  int iterations = 0;
  lap_time::PlantLimitOptions options{.time_step = 0.15};
  options.go_on = [&](std::string_view, int, double) { return ++iterations > 0; };
  const auto limit = [&] { return cached_limit(ring(), "udacity", {}, options, {}).value(); };
  const lap_time::PlantLimit whole = limit();
  ASSERT_TRUE(whole.is_whole() && whole.witness);
  ASSERT_GT(whole.effort.work, whole.of_optimum.work);
  iterations = 0;

  options.budget = whole.effort.work;
  EXPECT_EQ(to_bytes(limit()), to_bytes(whole));
  options.wants_witness = false;
  options.budget = whole.of_optimum.work;
  const lap_time::PlantLimit bound = limit();
  EXPECT_EQ(iterations, 0) << "from the cache";
  EXPECT_EQ(to_bytes(bound), to_bytes(*lap_time::find_plant_limit(ring(), "udacity", {}, options)));

  options.budget = 0.5 * whole.of_optimum.work;  // less than it took: another answer
  iterations = 0;
  EXPECT_FALSE(limit().is_whole());
  EXPECT_GT(iterations, 0);
}

TEST_F(PlanCacheTest, OfAScenarioOneIsKnownOnceItWasFound) {
  const auto scenario = test::scenario_of({{"car", "udacity"}});
  EXPECT_FALSE(known_limit(scenario, ring()));
  const lap_time::PlantLimit found = limit_of(scenario, ring(), {.wants_witness = false}).value();
  const auto known = test::good(known_limit(scenario, ring()));
  EXPECT_EQ(to_bytes(*known), to_bytes(found));

  const auto small = test::scenario_of({{"car", "f1tenth"}});
  EXPECT_FALSE(known_limit(small, ring()));
  EXPECT_EQ(test::refusal_of(limit_of(small, ring(), {})),
            "limit: got the model car f1tenth, expected one in full size");
}

TEST_F(PlanCacheTest, ThatACarGetsRoundIsKeptAndThatItDoesNotIsComputedAnew) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(cached_room(ring(), model::udacity_params(), infinite, 1.0));
  EXPECT_TRUE(cached_room(ring(), model::udacity_params(), infinite, 1.0)) << "from the cache";
  model::VehicleParams stiff = model::udacity_params();
  stiff.steer_limit = 0.03;
  for (int i = 0; i < 2; ++i)
    EXPECT_THAT(test::refusal_of(cached_room(ring(), stiff, infinite, 1.0)),
                HasSubstr("circle at full lock"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(PlanCacheTest, AStoppedSearchIsNotKept) {
  const auto stopped =
      cached_plan(ring(), model::udacity_params(), {.go_on = [](int, double) { return false; }});
  EXPECT_FALSE(stopped);
  EXPECT_FALSE(cache_->find(name_of_plan(ring(), model::udacity_params(), {})));
}

TEST(PlanBytes, EachCutOfAPlanIsRefused) {
  road::RacingLine line{.car = "udacity", .track = "ring", .length = 10.0, .points = {{}, {.s = 10.0}}};
  const std::string bytes = to_bytes(line);
  ASSERT_TRUE(from_bytes<road::RacingLine>(bytes));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(from_bytes<road::RacingLine>(std::string_view(bytes).substr(0, size))) << size;
  EXPECT_FALSE(from_bytes<road::RacingLine>(bytes + "x"));
}

TEST(Planning, EndsWithTheProcessesFlag) {
  static std::atomic<bool> flag{false};
  stop_planning_by(flag);
  EXPECT_FALSE(must_stop_planning());
  flag = true;
  EXPECT_TRUE(must_stop_planning());
  flag = false;
}

class DiskCacheTest : public testing::Test, protected test::Folder {
 protected:
  [[nodiscard]] DiskCache cache(std::uint64_t most = DiskCache::kMostBytes) {
    return DiskCache(
        folder_.string(), [this](std::string_view line) { said_.emplace_back(line); }, most);
  }
  [[nodiscard]] fs::path file(std::string_view name) const {
    return folder_ / (std::string(name) + ".cache");
  }

  std::vector<std::string> said_;
};

TEST_F(DiskCacheTest, GivesBackWhatWasKept) {
  const std::string bytes("a\0b", 3);
  EXPECT_FALSE(cache().find("11"));
  cache().keep("11", bytes);
  EXPECT_EQ(cache().find("11"), bytes);
  EXPECT_FALSE(cache().find("12"));
  EXPECT_TRUE(said_.empty());
}

TEST_F(DiskCacheTest, ADamagedFileIsIgnoredWithOneLine) {
  cache().keep("11", std::string(1000, 'x'));
  const auto damage = [&](auto how) {
    cache().keep("11", std::string(1000, 'x'));
    how();
    said_.clear();
    EXPECT_FALSE(cache().find("11"));
    ASSERT_EQ(said_.size(), 1U);
    EXPECT_THAT(said_[0], HasSubstr(file("11").string() + " is damaged and ignored"));
  };
  damage([&] { fs::resize_file(file("11"), 500); });
  damage([&] { fs::resize_file(file("11"), 0); });
  damage([&] {
    std::fstream stream(file("11"), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(700);
    stream.put('y');
  });
  damage([&] { std::ofstream(file("11")) << "something else"; });
  cache().keep("11", "new");
  EXPECT_EQ(cache().find("11"), "new");
}

TEST_F(DiskCacheTest, RemovesWhatWasUnusedForLongest) {
  const std::string bytes(1000, 'x');
  const DiskCache small = cache(2500);
  const auto used = [&](std::string_view name, int minutes_ago) {
    fs::last_write_time(file(name), fs::file_time_type::clock::now() - std::chrono::minutes(minutes_ago));
  };
  small.keep("1a", bytes);
  small.keep("2b", bytes);
  used("1a", 30);
  used("2b", 20);
  EXPECT_TRUE(small.find("1a")) << "now 2b is the one unused for longest";
  small.keep("3c", bytes);
  EXPECT_TRUE(fs::exists(file("1a")));
  EXPECT_FALSE(fs::exists(file("2b")));
  EXPECT_TRUE(fs::exists(file("3c")));
}

TEST_F(DiskCacheTest, KeepsABoundedNumberOfFiles) {
  for (std::size_t i = 0; i < DiskCache::kMostFiles + 20; ++i) std::ofstream(file(std::to_string(i))) << "x";
  cache().keep("abc", "x");
  EXPECT_EQ(cache().find("abc"), "x");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}),
            static_cast<std::ptrdiff_t>(DiskCache::kMostFiles));
}

TEST_F(DiskCacheTest, TwoProcessesAndAKillLeaveWholeFiles) {
  const std::string bytes(200000, 'x');
  std::vector<pid_t> children;
  for (int child = 0; child < 2; ++child) {
    const pid_t id = ::fork();
    if (id == 0) {
      const DiskCache ours(folder_.string());
      for (;;) ours.keep("11", bytes);
    }
    children.push_back(id);
  }
  int seen = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (seen < 200 && std::chrono::steady_clock::now() < end) {
    const auto found = cache().find("11");
    if (!found) continue;
    EXPECT_EQ(*found, bytes);
    ++seen;
  }
  for (const pid_t id : children) {
    ::kill(id, SIGKILL);
    ::waitpid(id, nullptr, 0);
  }
  EXPECT_EQ(seen, 200);
  EXPECT_TRUE(said_.empty()) << said_.front();
  EXPECT_EQ(cache().find("11"), bytes) << "after the kill";
}

TEST_F(DiskCacheTest, RemovesWhatAKilledProcessLeft) {
  cache().keep("11", "x");
  const fs::path old = folder_ / "22.cache.1-0.part";
  const fs::path recent = folder_ / "22.cache.2-0.part";
  std::ofstream(old) << "half";
  std::ofstream(recent) << "half";
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(2));
  cache().keep("11", "x");
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(recent)) << "another process may be writing it";
}

TEST_F(DiskCacheTest, AFolderThatCannotBeMadeCostsNothingButTime) {
  const DiskCache nowhere("/dev/null/chicane");
  nowhere.keep("11", "x");
  EXPECT_FALSE(nowhere.find("11"));
}

TEST_F(DiskCacheTest, StandsWhereTheUsersCachesAre) {
  const char* const old = std::getenv("HOME");
  const std::string kept = old != nullptr ? old : "";
  for (const auto& [cache, home, folder] : {std::tuple{"/var/c", "/home/me", "/var/c/chicane"},
                                            {"relative", "/home/me", "/home/me/.cache/chicane"},
                                            {"", "/home/me", "/home/me/.cache/chicane"},
                                            {"", "", ""}}) {
    ::setenv("XDG_CACHE_HOME", cache, 1);
    ::setenv("HOME", home, 1);
    EXPECT_EQ(DiskCache::default_folder(), folder);
  }
  ::setenv("HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace chicane::run
