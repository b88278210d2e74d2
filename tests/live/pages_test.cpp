// SPDX-License-Identifier: MIT
#include "chicane/live/pages.hpp"

#include "chicane/live/what_if.hpp"
#include "chicane/wire/endpoint.hpp"
#include "support/chicane_test.hpp"

namespace chicane::live {
namespace {

TEST(Pages, OfALiveRunSaySoAndOfAReplayNameItsLogsAndServeNoOtherFile) {
  wire::Router router(nullptr, nullptr);
  const net::ServerHandlers live = router.handlers(live_pages());
  const auto mode = test::good(live.on_get("/mode.json"));
  EXPECT_EQ(mode->content_type, "application/json");
  EXPECT_EQ(mode->bytes, "{\"mode\":\"live\"}\n");
  EXPECT_FALSE(live.on_get("/log/0.mcap"));
  const auto replay = router.handlers(
      replay_pages({{"run \"1\".mcap", "/tmp/run.mcap"}, {"branch at 12.0 s", "/tmp/b"}}, 12.0));
  EXPECT_EQ(replay.on_get("/mode.json")->bytes,
            "{\"mode\":\"replay\",\"logs\":[{\"name\":\"run \\\"1\\\".mcap\",\"url\":\"/log/0.mcap\"},"
            "{\"name\":\"branch at 12.0 s\",\"url\":\"/log/1.mcap\"}],\"start_s\":12.0}\n");
  EXPECT_EQ(replay.on_get("/log/1.mcap")->file, "/tmp/b");
  for (const char* path : {"/log/2.mcap", "/log/", "/log/../tmp/b", "/tmp/b", "/log/01.mcap", ""})
    EXPECT_FALSE(replay.on_get(path)) << path;
}

TEST(Pages, OfAReplayTellTheSettingsThatAnotherFutureMayHave) {
  wire::Router router(nullptr, nullptr);
  WhatIf what_if([](const WhatIfQuestion&, const recording::BranchHooks&) -> Result<recording::BranchReport> {
    return fail(ErrorCode::kInvalidArgument, "nothing");
  });
  wire::Pages pages = replay_pages({{"a", "/tmp/a"}, {"b", "/tmp/b", "[1]"}}, 0.0);
  add_what_if(pages, what_if);
  const auto handlers = router.handlers(std::move(pages));
  EXPECT_FALSE(handlers.on_get("/log/0.settings.json")) << "none are known";
  EXPECT_EQ(handlers.on_get("/log/1.settings.json")->bytes, "[1]");
  EXPECT_EQ(handlers.on_get("/what_if.json")->bytes, "{\"id\":0,\"state\":\"none\"}\n");
}

}  // namespace
}  // namespace chicane::live
