// SPDX-License-Identifier: MIT
#include "chicane/protocol/data_folders.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

std::vector<std::string> folders_of(const DataOrigins& origins) { return data_folders(origins, "tracks"); }

/// The places that are searched whatever the origins are.
std::size_t count_of_fixed_places() { return folders_of({}).size(); }

TEST(DataFolders, AreTheWorkingFolderFirstAndTheSystemLast) {
  const std::vector<std::string> folders = folders_of({});
  EXPECT_EQ(folders.front(), "./tracks");
  EXPECT_EQ(folders.back(), "/usr/share/chicane/tracks");
}

TEST(DataFolders, AreBesideTheProgramAndInThePrefixAndOneFolderFurtherUp) {
  std::vector<std::string> folders = folders_of({.program = "/none/such/bin/program"});
  folders.resize(4);
  EXPECT_THAT(folders, ElementsAre("./tracks", "/none/such/bin/share/chicane/tracks",
                                   "/none/such/share/chicane/tracks", "/none/share/chicane/tracks"));
}

TEST(DataFolders, OfTheEnvironmentComeBeforeTheProgramsAndTheLibrarysAfter) {
  std::vector<std::string> folders =
      folders_of({.environment = "/mine",
                  .program = "/none/bin/python3",
                  .shared_object = "/none/lib/module/chicane.so",
                  .header = "/none/prefix/include/chicane/protocol/data_folders.hpp"});
  const auto place = [&](std::string_view folder) {
    return std::find(folders.begin(), folders.end(), folder) - folders.begin();
  };
  EXPECT_EQ(place("/mine/tracks"), 1);
  EXPECT_LT(place("/none/share/chicane/tracks"), place("/none/lib/module/share/chicane/tracks"));
  EXPECT_LT(place("/none/lib/module/share/chicane/tracks"), place("/none/prefix/share/chicane/tracks"));
  EXPECT_LT(place("/none/prefix/share/chicane/tracks"), place("/usr/share/chicane/tracks"));
}

TEST(DataFolders, AreNamedOnce) {
  const DataOrigins origins{.program = "/none/bin/program", .shared_object = "/none/bin/program"};
  EXPECT_EQ(folders_of(origins).size(), count_of_fixed_places() + 3);
  for (const std::string& here : {std::string("."), std::filesystem::current_path().string()})
    EXPECT_EQ(folders_of({.environment = here}), folders_of({})) << "the working folder is the first one";
}

TEST(DataOrigins, AreThisProgramAndNoInstallation) {
  const DataOrigins origins = data_origins();
  EXPECT_EQ(std::filesystem::path(origins.program).filename(), "protocol_test");
  EXPECT_EQ(origins.header, "") << "tests are compiled with the source tree, not with an installation";
  ::setenv("CHICANE_DATA_DIR", "/mine", 1);
  EXPECT_EQ(data_origins().environment, "/mine");
  ::unsetenv("CHICANE_DATA_DIR");
}

TEST(BuildIds, AreThoseOfThisProgramAndOfItsLibraries) {
  const std::string ids = build_ids();
  EXPECT_GE(ids.size(), 40U) << "20 bytes each: this program's, and that of the C library";
  EXPECT_EQ(build_ids(), ids);
}

}  // namespace
}  // namespace chicane::protocol
