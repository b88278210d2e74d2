// SPDX-License-Identifier: MIT
#include "chicane/protocol/json.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

TEST(ReportDocument, KeepsSectionsAndPartsInTheirOrder) {
  ReportDocument document("sweep", "small & <plain>");
  document.add_text("10 runs, `laps=1`.");
  document.begin_section("Tables");
  document.add_table({"preset", "clean"}, Json::array({{"pid", Json{{"text", "50 %"}, {"share", 0.5}}}}));
  document.add_grid("one", {"a \\ b", "1"}, Json::array({{"2", "0"}}));
  EXPECT_EQ(document.text(),
            R"({"kind":"sweep","title":"small & <plain>","sections":[)"
            R"({"title":"","parts":[{"part":"text","text":"10 runs, `laps=1`."}]},)"
            R"({"title":"Tables","parts":[{"part":"table","title":"","columns":["preset","clean"],)"
            R"("rows":[["pid",{"text":"50 %","share":0.5}]]},)"
            R"({"part":"grid","title":"one","columns":["a \\ b","1"],"rows":[["2","0"]]}]}]})");
}

TEST(ReportDocument, PlotsRoundEachAxisToWhatAScreenShows) {
  ReportDocument document("import", "road");
  document.begin_map("here", "x [m]");
  document.add_series("line", "other", "line", {1e6 + 0.123456, 0.0, 1e6 + 1.0, 1e-7, std::nan(""), 2e-7});
  document.add_series("mark", "soft", "", {0.6});
  EXPECT_EQ(
      json_text(parse_json(document.text())["sections"][0]["parts"][0]),
      R"({"part":"map","title":"here","x":"x [m]","series":[)"
      R"({"draw":"line","tone":"other","name":"line","values":[1000000.12346,0.0,1000001.0,1e-07,null,2e-07]},)"
      R"({"draw":"mark","tone":"soft","name":"","values":[0.6]}]})");
}

}  // namespace
}  // namespace chicane::protocol
