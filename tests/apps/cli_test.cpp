// SPDX-License-Identifier: MIT
// The program as a user meets it: words in, text and exit codes out.
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "apps/program_outcome.hpp"
#include "chicane/base/instruction_set.hpp"
#include "chicane/version.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::test {
namespace {

using Json = nlohmann::json;

TEST(Cli, SaysItsVersion) {
  const Outcome version = chicane_program("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, StartsWith("chicane " CHICANE_VERSION "\n"));
  const std::string left_out = instruction_sets_left_out();
  if (left_out.empty()) {
    EXPECT_EQ(version.out, "chicane " CHICANE_VERSION "\n");
  } else {
    EXPECT_THAT(version.out, HasSubstr("not built in: " + left_out));
  }
}

TEST(Cli, AFastRunShowsPeopleALimitThatTheCacheKnows) {
  const Folder cache;
  const std::string here = "XDG_CACHE_HOME='" + cache.path("") + "' " + kProgram;
  const std::string run = here + " drive --fast --laps 2 --track oval";
  EXPECT_THAT(shell(run).out, HasSubstr("limit              not known: not asked for (--limit)"));
  EXPECT_EQ(shell(run + " --limit").code, 0);
  EXPECT_THAT(shell(run).out, HasSubstr("limit              12.93"));
  EXPECT_TRUE(Json::parse(shell(run + " --json").out)["limit"].is_null())
      << "the same bytes, whatever it knows";
  EXPECT_THAT(shell(run + " --no-cache").out, HasSubstr("not asked for"));
}

/// What a simulator says that drives with `serve`, whose own words go to two files of the folder.
Outcome serve_and_simulate(const Folder& folder, const std::string& serve, const std::string& simulate) {
  const std::string said = "'" + folder.path("serve.txt") + "'";
  return shell(kProgram + "serve --port 0 " + serve + " > '" + folder.path("serve.json") + "' 2> " + said +
               " & server=$!; port=; while kill -0 $server && [ -z \"$port\" ]; do sleep 0.05; "
               "port=$(sed -n 's/.* on port \\([0-9]*\\);.*/\\1/p' " +
               said + "); done; " + kProgram + "simulate --connect ws://127.0.0.1:$port --json " + simulate +
               "; code=$?; kill -INT $server; wait $server; exit $code");
}

TEST(Cli, BothEndsOfTheSimulatorsSocketSetTheLapsBesideTheSameLimit) {
  const Folder folder;
  std::string points = "# x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  for (const Vec2& point : circle_points(20.0, 40))
    points += std::to_string(point.x()) + ',' + std::to_string(point.y()) + ",6,6\n";
  const std::string track = "--track '" + folder.write("circle.csv", points) + "' ";
  const Outcome outcome = serve_and_simulate(folder, track + "--json", track + "--laps 2");
  ASSERT_EQ(outcome.code, 0) << outcome.err << folder.content("serve.txt");
  const Json inside = Json::parse(outcome.out);
  const Json outside = Json::parse(folder.content("serve.json"));
  ASSERT_TRUE(inside["limit"].is_object()) << inside["why_no_limit"];
  EXPECT_EQ(inside["limit"], outside["limit"]);  // to the last bit
  ASSERT_EQ(inside["laps_completed"], 2);
  ASSERT_GE(outside["laps_completed"], 1);  // the simulator ends at the line
  EXPECT_TRUE(outside["why_no_limit"].is_null());
  const auto gap = [](const Json& run) { return run["laps"][0]["gap_to_limit_percent"].get<double>(); };
  const double limit = inside["limit"]["lap_time_s"];
  for (const Json& run : {inside, outside}) {
    EXPECT_NEAR(gap(run), 100.0 * (run["laps"][0]["lap_time_s"].get<double>() / limit - 1.0), 1e-9);
    EXPECT_TRUE(run["laps"][0]["sector_gaps_to_limit_percent"][2].is_number());
  }
  // On one machine telemetry is some milliseconds on its way; 0.3 s is for machines with much else to do.
  EXPECT_NEAR(inside["laps"][0]["lap_time_s"].get<double>(), outside["laps"][0]["lap_time_s"].get<double>(),
              0.3);
}

TEST(Cli, ServeSaysThatNobodyToldItTheRoad) {
  const Outcome outcome = interrupted_program("serve --port 0 --json", "waits for a simulator");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json run = Json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(run.is_discarded()) << outcome.out << outcome.err;
  EXPECT_TRUE(run["track"].is_null());
  EXPECT_TRUE(run["limit"].is_null());
  EXPECT_THAT(run["why_no_limit"].get<std::string>(), HasSubstr("--track"));
}

TEST(Cli, ARecordingOfServeSaysThatTheRoadIsKnownFromWaypointsAndReplays) {
  const Folder folder;
  const std::string log = "'" + folder.path("run.mcap") + "'";
  const Outcome outcome = serve_and_simulate(folder, "--record " + log, "--set time_limit_s=6");
  EXPECT_THAT(outcome.out, StartsWith("{")) << outcome.err << folder.content("serve.txt");
  const Outcome verified = chicane_program("replay " + log + " --verify --json");
  EXPECT_EQ(verified.code, 0) << verified.err << verified.out;
  const Json report = Json::parse(verified.out);
  EXPECT_GT(report["steps"], 10);
  EXPECT_EQ(report["identical"], report["steps"]);
}

TEST(Cli, ARecordedRunIsVerifiedBitForBit) {
  const Folder folder;
  const std::string log = folder.path("run.mcap");
  const std::string arguments = "drive --fast --laps 1 --set time_limit_s=20 --record '" + log + "'";
  EXPECT_THAT(chicane_program(arguments).err, HasSubstr("recorded 500 steps"));
  const Outcome second = chicane_program(arguments);
  EXPECT_EQ(second.code, 3);
  EXPECT_THAT(second.err, HasSubstr("exists"));

  const Outcome verified = chicane_program("replay '" + log + "' --verify --json");
  EXPECT_EQ(verified.code, 0) << verified.err;
  const Json report = Json::parse(verified.out);
  EXPECT_EQ(report["steps"], 500);
  EXPECT_EQ(report["identical"], 500);
  EXPECT_EQ(report["first_difference"], nullptr);
  EXPECT_THAT(chicane_program("replay '" + log + "' --verify").out, HasSubstr("100 %"));
  EXPECT_EQ(chicane_program("replay '" + log + "' --no-serve").code, 2);
  EXPECT_EQ(chicane_program("replay README.md --verify").code, 2);
  EXPECT_EQ(chicane_program("replay no/such.mcap --verify").code, 3);
}

TEST(Cli, NothingIsLostToAFileOfTheSameName) {
  const Folder folder;
  const std::string log = "'" + folder.path("run.mcap") + "'";
  const std::string notes = folder.write("notes.txt", "mine");
  const std::string run = "drive --fast --laps 1 --set time_limit_s=4 --record " + log;
  EXPECT_THAT(chicane_program(run + " --report " + log).err,
              HasSubstr("expected another file than --record"));
  EXPECT_EQ(chicane_program(run + " --report " + log).code, 2);
  EXPECT_THAT(chicane_program(run).err, HasSubstr("recorded 100 steps"));
  const std::string recording = folder.content("run.mcap");
  for (const std::string& file : {notes, folder.path("run.mcap")}) {
    const Outcome branch =
        chicane_program("replay " + log + " --branch-at 2 --no-serve --output '" + file + "'");
    EXPECT_EQ(branch.code, 3);
    EXPECT_THAT(branch.err, HasSubstr("exists"));
  }
  const Outcome report = chicane_program("report " + log + " -o " + log);
  EXPECT_EQ(report.code, 2);
  EXPECT_THAT(report.err, HasSubstr("expected another file than a recording"));
  EXPECT_EQ(content_of(notes), "mine");
  EXPECT_EQ(folder.content("run.mcap"), recording);
  const Outcome cut = chicane_program("report '" + folder.write("cut.mcap", recording.substr(0, 60)) +
                                      "' -o '" + folder.path("cut.html") + "'");
  EXPECT_EQ(cut.code, 2);
  EXPECT_THAT(cut.err, HasSubstr("got a file that was cut in its first chunk, expected a recording"));
  EXPECT_FALSE(fs::exists(folder.path("cut.html")));
}

TEST(Cli, ABranchTellsTheCarsSpeedNotTheSensors) {
  const Folder folder;
  const std::string log = "'" + folder.path("run.mcap") + "'";
  EXPECT_THAT(chicane_program("drive --fast --laps 1 --set time_limit_s=4 --record " + log).err,
              HasSubstr("recorded 100 steps"));
  const Outcome outcome =
      chicane_program("replay " + log + " --branch-at 2 --set fault.nan_measurement=true --json");
  const Json report = Json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(report.is_discarded()) << outcome.out << outcome.err;
  for (const char* future : {"recorded", "branch"}) {
    ASSERT_TRUE(report[future]["mean_speed_mps"].is_number()) << outcome.out;
    EXPECT_GT(report[future]["mean_speed_mps"].get<double>(), 1.0);
  }
}

TEST(Cli, ARunWritesItsReport) {
  const Folder folder;
  const std::string page = folder.path("run.html");
  const std::string arguments = "drive --fast --laps 1 --set time_limit_s=5 --json --report '" + page + "'";
  const Outcome outcome = chicane_program(arguments);
  EXPECT_FALSE(Json::parse(outcome.out, nullptr, false).is_discarded()) << outcome.out;
  EXPECT_THAT(outcome.err, HasSubstr("open it in a browser"));
  EXPECT_THAT(content_of(page), HasSubstr("\"name\":\"run.html\""));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path("")), {}), 1) << "nothing but the page is left";
  const std::string log = folder.path("run.mcap");
  const Outcome both = chicane_program(arguments + " --record '" + log + "'");
  EXPECT_THAT(both.err, HasSubstr("recorded 125 steps"));
  EXPECT_THAT(content_of(page), HasSubstr("\"name\":\"run.mcap\""));
  EXPECT_EQ(chicane_program("replay '" + log + "' --verify").code, 0);

  const Outcome nowhere = chicane_program("drive --fast --laps 9 --report no/such/folder/run.html");
  EXPECT_EQ(nowhere.code, 3);
  EXPECT_THAT(nowhere.err, HasSubstr("no/such/folder/run.html: cannot be written"));
  EXPECT_EQ(chicane_program("limit --track oval --car road-car --csv /no/such/folder/line.csv").code, 3);
}

TEST(Cli, FindsAFileByItsPathOfTheLastVersion) {
  const Outcome outcome = chicane_program("check presets/weighted.yaml");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("presets/weighted.yaml lies in data/ now: reading data/presets/"));
  EXPECT_EQ(chicane_program("check presets/none.yaml").code, 2);
}

TEST(Cli, ThePagesOfParametersAndFaultsAreInStepWithTheProgram) {
  const std::string pages = CHICANE_SOURCE_DIR "/docs/reference/";
  EXPECT_TRUE(chicane_program("list parameters --markdown").out == content_of(pages + "configuration.md"))
      << "run: chicane list parameters --markdown > docs/reference/configuration.md";
  EXPECT_THAT(content_of(pages + "shipped.md"), HasSubstr(chicane_program("list faults --markdown").out))
      << "the table is what chicane list faults --markdown prints";
}

TEST(Cli, APortThatIsTakenIsTheEnvironmentsFault) {
  const int taken = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(::bind(taken, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(taken, 1), 0);
  ASSERT_EQ(::getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string port = std::to_string(ntohs(address.sin_port));
  for (const char* command : {"serve --port ", "drive --laps 1 --port "}) {
    const Outcome outcome = chicane_program(command + port);
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(port));
  }
  ::close(taken);
}

TEST(Cli, PrintsALinkWithItsTokenAndEndsARunAtCtrlCWithTheResultsSoFar) {
  const Outcome one = interrupted_program("drive --port 0 --laps 9 --json", "Ctrl-C ends");
  EXPECT_THAT(one.err,
              ::testing::ContainsRegex(R"(dashboard at http://localhost:[0-9]+/\?token=[-_A-Za-z0-9]+ )"));
  const Json report = Json::parse(one.out, nullptr, false);
  ASSERT_FALSE(report.is_discarded()) << one.out << one.err;
  EXPECT_EQ(report["completed"], false);
  EXPECT_EQ(one.code, 1);
  const Outcome none = interrupted_program("drive --port 0 --laps 9 --json --no-token", "Ctrl-C ends");
  EXPECT_THAT(none.err, ::testing::ContainsRegex("dashboard at http://localhost:[0-9]+/ [(]Ctrl-C ends[)]"));
}

TEST(Cli, ResultsThatCannotBeWrittenAreNotASuccess) {
  const Outcome outcome = chicane_program("list presets > /dev/full");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("could not be written"));
}

TEST(Cli, NothingASimulatorStartedOutlivesIt) {
  const fs::path note = fs::path(::testing::TempDir()) / ("chicane_child_" + std::to_string(::getpid()));
  fs::remove(note);
  const pid_t simulator = ::fork();
  if (simulator == 0) {
    // The shell waits for what it started: who ends the shell alone leaves that behind.
    const std::string server = "sleep 600 & echo $! > '" + note.string() + "'; wait";
    ::execl(CHICANE_PROGRAM, "chicane", "simulate", "--connect", "ws://127.0.0.1:1/", "--server",
            server.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  const auto wait_until = [](const auto& holds) {
    for (int i = 0; i < 2000 && !holds(); ++i) ::usleep(10000);
    return holds();
  };
  pid_t child = 0;
  EXPECT_TRUE(wait_until([&] { return static_cast<bool>(std::ifstream(note) >> child); })) << "never started";
  ::kill(simulator, SIGKILL);
  ::waitpid(simulator, nullptr, 0);
  if (child > 0) {
    EXPECT_TRUE(wait_until([&] { return ::kill(child, 0) != 0; })) << "process " << child;
  }
  fs::remove(note);
}

}  // namespace
}  // namespace chicane::test
