// SPDX-License-Identifier: MIT
#include "chicane/identify/drive_log.hpp"

#include "chicane/base/random.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::identify {
namespace {

/// A circle to the left with 10 m radius at 5 m/s, 0.27 rad of steering, 20 samples a second.
struct Row {
  double time, x, y, psi, speed, steer;
};
std::string rows(const std::string& header, const std::function<std::string(const Row&)>& line,
                 int count = 200) {
  std::ostringstream text;
  text.precision(12);
  text << header << '\n';
  for (int i = 0; i < count; ++i) {
    const double t = 0.05 * i, angle = 0.5 * t;
    text << line({t, 10.0 * std::sin(angle), 10.0 - 10.0 * std::cos(angle), angle, 5.0, 0.27}) << '\n';
  }
  return text.str();
}
std::string plain(const Row& r) {
  std::ostringstream text;
  text.precision(12);
  text << r.time << ',' << r.x << ',' << r.y << ',' << r.psi << ',' << r.speed << ',' << r.steer;
  return text.str();
}

class Csv : test::Folder {
 public:
  explicit Csv(const std::string& text) : file_{write("log.csv", text)} {}
  [[nodiscard]] Result<std::vector<DriveLog>> read(const LogOptions& options = {}) const {
    return read_log(file_, options);
  }
  [[nodiscard]] std::string refusal(const LogOptions& options = {}) const {
    return test::refusal_of(read(options));
  }

 private:
  std::string file_;
};

TEST(DriveLog, IsReadFromACsvFileWithoutAHeaderByPositions) {
  const std::string all = rows("", plain);
  const Csv csv(all.substr(1));
  const auto logs = test::good(csv.read(
      {.positions = {{0, "time"}, {1, "x"}, {2, "y"}, {3, "psi_rad"}, {4, "speed_mps"}, {5, "steer"}}}));
  ASSERT_EQ(logs->size(), 1U);
  EXPECT_EQ(logs->front().samples.size(), 200U);
  EXPECT_DOUBLE_EQ(logs->front().commands.front().steer, 0.27);
  EXPECT_THAT(csv.refusal({.positions = {{0, "time"}, {1, "x"}}}), HasSubstr("expected a column y"));
  EXPECT_THAT(
      csv.refusal({.positions = {{0, "time"}, {1, "x"}, {2, "y"}, {3, "psi"}, {4, "speed"}, {9, "steer"}}}),
      HasSubstr(":1: row: got 6 columns, expected 10"));
}

TEST(DriveLog, IsReadFromACsvFileWithAHeader) {
  const auto logs = test::good(Csv(rows("time,x,y,psi,speed,steer", plain)).read());
  ASSERT_EQ(logs->size(), 1U);
  const DriveLog& log = logs->front();
  ASSERT_EQ(log.samples.size(), 200U);
  EXPECT_EQ(log.commands.size(), 200U);
  EXPECT_FALSE(log.has_throttle());
  EXPECT_FALSE(log.is_centre_of_mass);
  EXPECT_NEAR(log.samples[10].psi, 0.25, 1e-9);
  EXPECT_NEAR(log.commands[10].steer, 0.27, 1e-9);
}

TEST(DriveLog, TakesUnitsFromTheNamesOfColumns) {
  const auto logs =
      Csv(rows("\xEF\xBB\xBFstamp_ms;pos_x;pos_y;yaw_deg;v_kmh;Steering_Angle_deg;pedal", [](const Row& r) {
        std::ostringstream text;
        text.precision(12);
        text << 1e3 * r.time << ';' << r.x << ';' << r.y << ';' << r.psi * 57.295779513082 << ';'
             << 3.6 * r.speed << ';' << r.steer * 57.295779513082 << ";0.5";
        return text.str();
      })).read();
  ASSERT_TRUE(logs) << logs.error().message;
  const DriveLog& log = logs->front();
  EXPECT_TRUE(log.has_throttle());
  EXPECT_NEAR(log.samples[20].time, 1.0, 1e-9);
  EXPECT_NEAR(log.samples[20].psi, 0.5, 1e-9);
  EXPECT_NEAR(log.samples[20].speed, 5.0, 1e-9);
  EXPECT_NEAR(log.commands[20].steer, 0.27, 1e-9);
}

TEST(DriveLog, TakesColumnsByNameWhereTheyAreTold) {
  const Csv file(rows("time,x,y,psi,speed,my_column", plain));
  EXPECT_THAT(file.refusal(),
              HasSubstr(":1: header: got time,x,y,psi,speed,my_column, expected a column steer; "
                        "name it by --columns steer=NAME"));
  EXPECT_EQ(file.refusal({.columns = {{"steer", "my_column"}}}), "");
  EXPECT_THAT(file.refusal({.columns = {{"steer", "yours"}}}), HasSubstr("got no column yours"));
}

TEST(DriveLog, RefusesWhatCannotBeWhatItsColumnSays) {
  const auto with = [](double psi, double speed, double steer) {
    return Csv(rows("time,x,y,psi,speed,steer",
                    [=](const Row& r) {
                      return plain({r.time, r.x, r.y, psi * r.psi, speed * r.speed, steer * r.steer});
                    }))
        .refusal();
  };
  EXPECT_EQ(with(1.0, 1.0, 1.0), "");
  EXPECT_THAT(with(1.0, 1.0, 57.3), HasSubstr("is it in degrees?"));
  EXPECT_THAT(with(1.0, 2.237, 1.0), HasSubstr("is it in mph?"));
  EXPECT_THAT(with(1.0, 3.6, 1.0), HasSubstr("is it in km/h?"));
  EXPECT_THAT(with(-1.0, 1.0, 1.0), HasSubstr("psi: got"));
  EXPECT_THAT(with(1.0, 1.0, -1.0),
              HasSubstr("steer: got steering against the turning, expected left positive"));
}

// A model car at 1 m/s moves 2.5 cm from sample to sample: with 5 cm of noise its path seems to be twice as
// long.
TEST(DriveLog, TakesNoiseOfThePlaceForNoOtherSpeed) {
  std::ostringstream text;
  text << "time,x,y,psi,speed,steer\n";
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.025 * i, angle = 0.5 * t;
    text << t << ',' << 2.0 * std::sin(angle) + 0.05 * random.normal() << ','
         << 2.0 - 2.0 * std::cos(angle) + 0.05 * random.normal() << ',' << angle << ",1,0.15\n";
  }
  EXPECT_EQ(Csv(text.str()).refusal(), "");
}

TEST(DriveLog, NamesLineAndColumnOfAWrongCell) {
  std::string text = rows("time,x,y,psi,speed,steer", plain);
  EXPECT_THAT(Csv(text + "10.0,1,2,nan,5,0.1\n").refusal(),
              HasSubstr(":202: psi: got nan, expected a finite number"));
  EXPECT_THAT(Csv(text + "10.0,1,2\n").refusal(), HasSubstr(":202: row: got 3 columns, expected 6"));
  EXPECT_THAT(Csv("").refusal(), HasSubstr("got no header"));
  EXPECT_THAT(Csv(rows("time,x,y,psi,speed,steer", plain, 20)).refusal(),
              HasSubstr("expected at least 20 m"));
}

/// Writes a bag as other programs do: odometry and commands on topics of their own, in CDR.
void write_bag(const std::string& file, bool has_second_odometry) {
  std::filesystem::remove(file);
  const auto writer = test::good(telemetry::McapWriter::create(file, "test", false));
  const auto odom = (*writer)->add_channel("/pf/odom", protocol::OdometryMessage::kType, "");
  const auto other =
      has_second_odometry ? (*writer)->add_channel("/odom", protocol::OdometryMessage::kType, "") : odom;
  const auto drive = (*writer)->add_channel("/cmd", protocol::DriveMessage::kType, "");
  constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
  for (int i = 0; i < 200; ++i) {
    const std::int64_t stamp = kStart + 50'000'000LL * i;
    const double angle = 0.025 * i;
    protocol::OdometryMessage at{.stamp = stamp, .frame = "map", .child_frame = "base_link"};
    at.pose = {10.0 * std::sin(angle), 10.0 - 10.0 * std::cos(angle),
               std::remainder(angle, 6.283185307179586)};
    at.vx = 5.0;
    at.yaw_rate = 0.5;
    const protocol::DriveMessage commands{.stamp = stamp, .frame = "base_link", .steer = 0.27, .speed = 5.0};
    const auto time = static_cast<std::uint64_t>(stamp);
    ASSERT_TRUE((*writer)->write(odom, time, time, protocol::encode(at)));
    if (has_second_odometry) {
      ASSERT_TRUE((*writer)->write(other, time, time, protocol::encode(at)));
    }
    ASSERT_TRUE((*writer)->write(drive, time, time, protocol::encode(commands)));
  }
  ASSERT_TRUE((*writer)->close());
}

// A yaw rate of 0 all along a bend was fitted: inertia 143 for 2000 kg m².
TEST(DriveLog, AYawRateThatIsZeroThroughoutIsNone) {
  const auto with = [](const char* rate) {
    return Csv(rows("t,x,y,psi,v,steer,yaw_rate", [&](const Row& r) { return plain(r) + ',' + rate; }))
        .read();
  };
  const auto none = with("0"), some = with("0.5");
  ASSERT_TRUE(none && some);
  EXPECT_TRUE(std::isnan(none->front().samples[10].yaw_rate));
  EXPECT_EQ(some->front().samples[10].yaw_rate, 0.5);
}

TEST(DriveLog, IsReadFromABagOfOdometryAndCommands) {
  const test::Folder folder;
  const std::string file = folder.path("log.mcap");
  write_bag(file, false);
  const auto logs = test::good(read_log(file, {}));
  ASSERT_EQ(logs->size(), 1U);
  const DriveLog& log = logs->front();
  ASSERT_EQ(log.samples.size(), 200U);
  EXPECT_NEAR(log.samples[199].time, 9.95, 1e-9);
  EXPECT_NEAR(log.samples[199].psi, 4.975, 1e-9) << "not wrapped";
  EXPECT_NEAR(log.samples[10].yaw_rate, 0.5, 1e-12);
  EXPECT_NEAR(log.commands[10].steer, 0.27, 1e-6);
  EXPECT_FALSE(log.is_centre_of_mass);

  write_bag(file, true);
  EXPECT_THAT(test::refusal_of(read_log(file, {})),
              HasSubstr("got the topics /odom, /pf/odom of nav_msgs/msg/Odometry, expected "
                        "one; name it by --odom-topic"));
  EXPECT_TRUE(read_log(file, {.odom_topic = "/odom"}));
}

TEST(DriveLog, IsReadFromTheFolderThatRosbag2Writes) {
  const test::Folder folder;
  const std::string bag = folder.path("");
  EXPECT_THAT(test::refusal_of(read_log(bag, {})), HasSubstr("got a folder without .mcap or .db3"));
  EXPECT_THAT(test::refusal_of(read_log(folder.write("old.bag", "#ROSBAG V2.0\n"), {})),
              HasSubstr("got a bag of ROS 1, expected one of ROS 2"));
  folder.write("metadata.yaml", "rosbag2_bagfile_information:\n");
  write_bag(folder.path("bag_0.mcap"), false);
  EXPECT_EQ(test::good(read_log(bag, {}))->size(), 1U);
  EXPECT_TRUE(read_plain_log(bag, {}));
  write_bag(folder.path("bag_1.mcap"), false);
  EXPECT_EQ(test::good(read_log(bag, {}))->size(), 2U) << "parts of a bag that was split";
  EXPECT_THAT(test::refusal_of(read_plain_log(bag, {})), HasSubstr("got a bag of 2 files"));
}

TEST(DriveLog, IsPartedAtGapsAndJumps) {
  std::ostringstream text;
  text << "time,x,y,psi,speed,steer\n";
  double x = 0.0;
  for (int i = 0; i < 400; ++i) {
    if (i == 150) x += 30.0;
    const double time = 0.05 * i + (i >= 250 ? 2.0 : 0.0);
    text << plain({time, x, 0.0, 0.0, 5.0, 0.0}) << '\n';
    x += 0.25;
  }
  const auto logs = test::good(Csv(text.str()).read());
  ASSERT_EQ(logs->size(), 3U);
  EXPECT_EQ((*logs)[0].samples.size(), 150U);
  EXPECT_EQ((*logs)[1].samples.size(), 100U);
  EXPECT_EQ((*logs)[2].samples.size(), 150U);
}

TEST(SqliteBag, HasItsOdometryAndCommands) {
  const std::string folder = std::string(CHICANE_SOURCE_DIR) + "/tests/fuzz/corpus/bag/";
  const auto log = test::good(read_plain_log(folder + "plain.db3", {}));
  ASSERT_EQ(log->samples.size(), 6U);
  EXPECT_NEAR(log->samples[5].time - log->samples[0].time, 0.5, 1e-9);
  EXPECT_NEAR(log->samples[5].psi, 0.5, 1e-9);
  EXPECT_NEAR(log->samples[5].x, 10.0 * std::sin(0.5), 1e-9);
  EXPECT_EQ(log->samples[5].speed, 10.0);
  ASSERT_EQ(log->commands.size(), 6U);
  EXPECT_NEAR(log->commands[2].steer, 0.03, 1e-7) << "a float";
  EXPECT_FALSE(log->has_throttle());
  const auto two = read_plain_log(folder + "two_topics.db3", {});
  EXPECT_TRUE(two) << "messages that cannot be read are none";
  EXPECT_EQ(
      read_plain_log(folder + "empty.db3", {}).error().message,
      folder +
          "empty.db3: got the topics none of nav_msgs/msg/Odometry, expected one; name it by --odom-topic");
  EXPECT_EQ(
      read_plain_log(folder + "other.db3", {}).error().message,
      folder +
          "other.db3: got a bag that cannot be read: no such table: topics, expected a database of rosbag2");
  EXPECT_EQ(read_plain_log(folder + "none.db3", {}).error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace chicane::identify
