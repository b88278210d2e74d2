// SPDX-License-Identifier: MIT
#include "chicane/protocol/track_codec.hpp"

#include "chicane/protocol/library.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

TEST(TrackCodec, FindsTheFormatByTheEndOfTheName) {
  for (const std::string_view extension : track_extensions()) {
    const TrackFormat* const format = track_format_of("roads/mine" + std::string(extension));
    ASSERT_NE(format, nullptr) << extension;
    EXPECT_EQ(format->extension, extension);
    EXPECT_TRUE(extension.starts_with("."));
  }
  EXPECT_EQ(track_format_of("cars/road-car.yaml"), nullptr);
  EXPECT_EQ(track_format_of(""), nullptr);
}

TEST(TrackCodec, ReadsAFileOfAnUnknownNameAsTheFirstFormat) {
  EXPECT_EQ(parse_track("x,y\n0,1\n2,3\n", "points.txt")->points.size(), 2U);
}

TEST(TrackCodec, RefusesTooMuchInEveryFormat) {
  const std::string large(kMaxTrackBytes + 1, ' ');
  for (const std::string_view extension : track_extensions()) {
    EXPECT_THAT(parse_track(large, "a" + std::string(extension)).error().message,
                HasSubstr(": file: got 67108865 bytes, expected at most 64 MiB"));
    EXPECT_EQ(parse_track("", "a" + std::string(extension), {.default_left = -1.0}).error().code,
              ErrorCode::kInvalidArgument);
  }
}

TEST(TrackCodec, NamesAMissingFile) {
  const Result<road::Track> track = read_track("no/such/track.csv");
  ASSERT_FALSE(track);
  EXPECT_EQ(track.error().code, ErrorCode::kNotFound);
}

TEST(TrackCodec, TheLibraryHasTheTracksOfEveryFormat) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "chicane_track_formats";
  fs::create_directories(folder / "tracks");
  ::setenv("CHICANE_DATA_DIR", folder.c_str(), 1);
  int number = 0;
  for (const std::string_view extension : track_extensions()) {
    const std::string name = "format-" + std::to_string(++number);
    std::ofstream(folder / "tracks" / (name + std::string(extension))) << "\n";
    const Result<std::string> file = locate(Shelf::kTrack, name);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_THAT(*file, ::testing::EndsWith(name + std::string(extension)));
    const std::vector<Entry> all = entries(Shelf::kTrack);
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Entry& each) { return each.name == name; }));
  }
  ::unsetenv("CHICANE_DATA_DIR");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace chicane::protocol
