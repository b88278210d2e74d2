// SPDX-License-Identifier: MIT
#include "chicane/recording/html_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "chicane/recording/excerpt.hpp"
#include "chicane/telemetry/mcap_reader.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::recording {
namespace {

using nlohmann::json;
using telemetry::TemporaryFile;
using testing::HasSubstr;

constexpr std::uint64_t kSecond = 1'000'000'000;

/// Ten seconds of two topics, one of them not drawn; `is_closed`: as it should be.
void write_log(const std::string& path, bool is_closed = true, std::size_t size = 100) {
  auto writer = telemetry::McapWriter::create(path, "test");
  ASSERT_TRUE(writer);
  ASSERT_TRUE((*writer)->add_metadata("run", {{"track", "lakeside"}}));
  const std::uint16_t frame = (*writer)->add_channel("/chicane/frame", "chicane_msgs/msg/Frame", "bool a\n");
  const std::uint16_t other = (*writer)->add_channel("/odom", "nav_msgs/msg/Odometry", "bool a\n");
  for (std::uint64_t i = 0; i < 250; ++i) {
    const std::uint64_t time = i * kSecond / 25;
    ASSERT_TRUE((*writer)->write(frame, time, time, std::string(size, 'f')));
    ASSERT_TRUE((*writer)->write(other, time, time, std::string(size, 'o')));
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
  [[nodiscard]] std::string page() const {
    std::ostringstream text;
    text << std::ifstream(page_).rdbuf();
    return text.str();
  }
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

TEST_F(ReportTest, ExcerptThinsTopicsAndKeepsTheRest) {
  write_log(log_.path());
  ASSERT_TRUE(excerpt(log_.path(), copy_, {.topics = {"/chicane/frame"}, .rate = 10.0}));
  std::map<std::string, int> counts;
  std::uint64_t last = 0;
  std::string track;
  const auto read = telemetry::read_mcap(
      copy_, {.on_message =
                  [&](const telemetry::McapMessage& message) {
                    const bool is_first = counts[message.channel.topic]++ == 0;
                    EXPECT_TRUE(is_first || message.log_time - last >= kSecond / 25);
                    last = message.log_time;
                  },
              .on_metadata = [&](std::string_view, const auto& entries) { track = entries.at("track"); }});
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->is_complete);
  EXPECT_EQ(counts.size(), 1U);
  EXPECT_NEAR(counts["/chicane/frame"], 100, 2);
  EXPECT_EQ(track, "lakeside");
}

TEST_F(ReportTest, ExcerptGivesARecordingThatWasNotClosedAnEnd) {
  write_log(log_.path(), false);
  const auto before = telemetry::read_mcap(log_.path(), {});
  ASSERT_TRUE(before);
  EXPECT_FALSE(before->is_complete);
  ASSERT_TRUE(excerpt(log_.path(), copy_, {}));
  const auto after = telemetry::read_mcap(copy_, {});
  ASSERT_TRUE(after);
  EXPECT_TRUE(after->is_complete);
  EXPECT_EQ(after->messages, before->messages);
}

TEST_F(ReportTest, IsOnePageThatAsksForNothing) {
  write_log(log_.path());
  const auto written = write("run.mcap");
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->rate, 10.0);
  EXPECT_NEAR(static_cast<double>(written->bytes), static_cast<double>(page().size()), 300.0);
  EXPECT_EQ(data()["logs"][0]["name"], "run.mcap");
  EXPECT_GT(data()["logs"][0]["mcap_base64"].get<std::string>().size(), 10'000U);
  EXPECT_THAT(page(), HasSubstr(base64("script")));
  EXPECT_THAT(page(), HasSubstr("default-src 'none'"));
  for (const char* outside : {"http:", "https:", "src=", "<link rel=\"stylesheet\""}) {
    EXPECT_THAT(page(), testing::Not(HasSubstr(outside)));
  }
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
  const auto bytes = write_document(page_, text, {.script = "script", .style = "style"});
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(*bytes, page().size());
  EXPECT_EQ(data(), json::parse(text));
  EXPECT_EQ(page().find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(write_document(page_, text, {}).error().code, ErrorCode::kNotFound);
}

TEST_F(ReportTest, KeepsLessWhereThereIsMuchAndRefusesTooMuch) {
  write_log(log_.path(), true, 1000);
  const auto less = write("run.mcap", 60'000);
  ASSERT_TRUE(less) << less.error().message;
  EXPECT_EQ(less->rate, 5.0);
  const auto none = write("run.mcap", 5'000);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("at one message a second, expected shorter or fewer"));
}

TEST_F(ReportTest, SaysWhatIsMissing) {
  const auto unreadable = write("run.mcap");
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(unreadable.error().code, ErrorCode::kIo);
  const auto without = write_report({.output = page_, .logs = {}, .bundle = {}});
  ASSERT_FALSE(without);
  EXPECT_THAT(without.error().message, HasSubstr("without its dashboard"));
  write_log(log_.path());
  page_ = "/no/such/folder/page.html";
  EXPECT_FALSE(write("run.mcap"));
}

}  // namespace
}  // namespace chicane::recording
