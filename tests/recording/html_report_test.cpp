// SPDX-License-Identifier: MIT
#include "chicane/recording/html_report.hpp"

#include <nlohmann/json.hpp>

#include "chicane/recording/replay.hpp"
#include "chicane/telemetry/mcap.hpp"
#include "recording/recorded_run.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using nlohmann::json;
using telemetry::TemporaryFile;

constexpr std::uint64_t kSecond = 1'000'000'000;

constexpr const char* kStep = "float64 time_s\nint32 rung\n";

/// A control step in CDR.
std::string step(double time, std::int32_t rung) {
  std::string bytes{"\0\1\0\0", 4};
  bytes.append(reinterpret_cast<const char*>(&time), sizeof time);
  return bytes.append(reinterpret_cast<const char*>(&rung), sizeof rung);
}

/// Ten seconds of two topics, one of them not drawn; `is_closed`: as it should be.
void write_log(const std::string& path, bool is_closed = true) {
  auto writer = test::good(telemetry::McapWriter::create(path, "test"));
  ASSERT_TRUE((*writer)->add_metadata("run", {{"track", "lakeside"}}));
  const std::uint16_t frame = (*writer)->add_channel("/chicane/frame", "chicane_msgs/msg/Frame", kStep);
  const std::uint16_t other = (*writer)->add_channel("/odom", "nav_msgs/msg/Odometry", "bool a\n");
  for (std::uint64_t i = 0; i < 250; ++i) {
    const std::uint64_t time = i * kSecond / 25;
    ASSERT_TRUE((*writer)->write(frame, time, time, step(0.04 * static_cast<double>(i), i == 101 ? 1 : 0)));
    ASSERT_TRUE((*writer)->write(other, time, time, std::string(100, 'o')));
  }
  if (is_closed) return;
  ASSERT_TRUE((*writer)->flush());
  const std::uint64_t end = (*writer)->bytes_written();
  writer->reset();
  std::filesystem::resize_file(path, end);  // as if the process had been killed
}

class ReportTest : public testing::Test {
 protected:
  ~ReportTest() override {
    std::filesystem::remove(copy_);
    std::filesystem::remove(page_);
  }
  [[nodiscard]] std::string page() const { return test::content_of(page_); }
  /// The JSON that the page gets.
  [[nodiscard]] json data() const {
    const std::string start = "<script type=\"application/json\" id=\"chicane-report\">";
    const std::string text = page();
    const std::size_t begin = text.find(start) + start.size();
    return json::parse(text.substr(begin, text.find("</script", begin) - begin));
  }
  Result<ReportSummary> write(const std::string& name, std::size_t most_bytes = 1U << 20U) {
    return write_report({.output = page_,
                         .logs = {{name, log_.path()}},
                         .bundle = {.script = "script", .style = "style"},
                         .most_bytes = most_bytes});
  }

  TemporaryFile log_;
  std::string copy_ = log_.path() + ".copy";
  std::string page_ = log_.path() + ".html";
};

TEST(Base64, IsThatOfTheStandard) {
  const std::map<std::string, std::string> cases{{"", ""},
                                                 {"f", "Zg=="},
                                                 {"fo", "Zm8="},
                                                 {"foo", "Zm9v"},
                                                 {"foob", "Zm9vYg=="},
                                                 {"fooba", "Zm9vYmE="},
                                                 {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : cases) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST_F(ReportTest, IndexedCopyHoldsEverything) {
  write_log(log_.path());
  ASSERT_TRUE(indexed_copy(log_.path(), copy_));
  std::map<std::string, int> counts;
  std::string track;
  const auto read = telemetry::read_mcap(
      copy_, {.on_message = [&](const telemetry::McapMessage& message) { ++counts[message.channel.topic]; },
              .on_metadata = [&](std::string_view, const auto& entries) { track = entries.at("track"); }});
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->is_complete);
  EXPECT_EQ(counts, (std::map<std::string, int>{{"/chicane/frame", 250}, {"/odom", 250}}));
  EXPECT_EQ(track, "lakeside");
}

TEST_F(ReportTest, IndexedCopyGivesARecordingThatWasNotClosedAnEnd) {
  write_log(log_.path(), false);
  const auto before = test::good(telemetry::read_mcap(log_.path(), {}));
  EXPECT_FALSE(before->is_complete);
  ASSERT_TRUE(indexed_copy(log_.path(), copy_));
  const auto after = test::good(telemetry::read_mcap(copy_, {}));
  EXPECT_TRUE(after->is_complete);
  EXPECT_EQ(after->messages, before->messages);
}

TEST_F(ReportTest, IsOnePageThatAsksForNothing) {
  write_log(log_.path());
  const auto written = test::good(write("run.mcap"));
  EXPECT_EQ(written->rate, 20.0);
  EXPECT_NEAR(static_cast<double>(written->bytes), static_cast<double>(page().size()), 300.0);
  const json document = data();
  EXPECT_EQ(document["kind"], "runs");
  EXPECT_EQ(document["logs"][0]["name"], "run.mcap");
  const json& run = document["logs"][0]["runs"].at(0);
  EXPECT_EQ(run["steps"]["count"], 250);
  const std::vector<double> times = run["frames"]["time_s"];
  EXPECT_NEAR(static_cast<double>(times.size()), 190.0, 15.0);
  // Where something changes, every step is kept.
  for (const double time : {4.04, 4.08}) EXPECT_THAT(times, Contains(time));
  EXPECT_THAT(page(), HasSubstr(base64("script")));
  EXPECT_THAT(page(), HasSubstr("default-src 'none'"));
  for (const char* outside : {"http:", "https:", "src=", "<link rel=\"stylesheet\""}) {
    EXPECT_THAT(page(), Not(HasSubstr(outside)));
  }
}

TEST_F(ReportTest, OfThreeLapsIsSmallAndHasTheirTimes) {
  record_run(log_.path(), "lakeside", "3");  // about 87 s
  const auto written = test::good(write("run.mcap"));
  // The page's own script and style come to less than 100 kB more: together at most 800 kB.
  EXPECT_LE(written->bytes, 700'000U);
  const json document = data();
  const json& run = document["logs"][0]["runs"].at(0);
  EXPECT_EQ(run["run"]["track"], json({"lakeside"}));
  ASSERT_EQ(run["laps"].size(), 3U);
  const double lap_time = run["laps"][2]["lap_time_s"][0];
  EXPECT_NEAR(lap_time, 26.0, 2.0);
  EXPECT_GT(document["logs"][0]["settings"].get<std::string>().size(), 100U);
  EXPECT_GT(run["centre"]["x_m"].size(), 100U);
  for (const char* drawn : {"s_m", "speed_mps", "throttle_applied", "front_tire_use"})
    EXPECT_GT(run["frames"][drawn].size(), 1500U) << drawn;
}

TEST_F(ReportTest, NamesCannotBreakOutOfTheScript) {
  write_log(log_.path());
  const std::string name = "</script><script>alert(1)</script><!--<script>\xff\".mcap";
  ASSERT_TRUE(write(name));
  EXPECT_EQ(data()["logs"][0]["name"].get<std::string>().substr(0, 40), name.substr(0, 40));
  EXPECT_EQ(page().find("alert(1)</script>"), std::string::npos);
}

TEST_F(ReportTest, DocumentsAreInThePageAsTheyAre) {
  const std::string text = R"({"title":"a & </script><script>alert(1)</script><!--"})";
  const auto bytes = test::good(write_document(page_, text, {.script = "script", .style = "style"}));
  EXPECT_EQ(*bytes, page().size());
  EXPECT_EQ(data(), json::parse(text));
  EXPECT_EQ(page().find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(write_document(page_, text, {}).error().code, ErrorCode::kNotFound);
}

TEST_F(ReportTest, KeepsLessWhereThereIsMuchAndRefusesTooMuch) {
  write_log(log_.path());
  const auto less = test::good(write("run.mcap", 15'000));
  EXPECT_EQ(less->rate, 10.0);
  EXPECT_THAT(test::refusal_of(write("run.mcap", 1'000)),
              HasSubstr("at one control step a second, expected shorter or fewer"));
}

TEST_F(ReportTest, SaysWhatIsMissing) {
  const auto unreadable = write("run.mcap");
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(unreadable.error().code, ErrorCode::kIo);
  EXPECT_THAT(test::refusal_of(write_report({.output = page_, .logs = {}, .bundle = {}})),
              HasSubstr("has no dashboard"));
  write_log(log_.path());
  page_ = "/no/such/folder/page.html";
  EXPECT_FALSE(write("run.mcap"));
}

}  // namespace
}  // namespace chicane::recording
