// SPDX-License-Identifier: MIT
// The table of docs/reference/security.md: every combination of address, token, Host, Origin, path and proof.
#include "chicane/net/detail/connections.hpp"
#include "support/chicane_test.hpp"

namespace chicane::net {
namespace {

constexpr const char* kToken = "0123456789abcdefghijklmnopqrstuv";

struct Host {
  const char* text;
  bool is_ours;      ///< when listening on 127.0.0.1
  bool is_ours_lan;  ///< when listening on 0.0.0.0
  bool is_loopback;
};
constexpr Host kHosts[] = {
    {"localhost:4567", true, true, true},
    {"LOCALHOST", true, true, true},
    {"127.0.0.1:4567", true, true, true},
    {"127.8.8.8", true, true, true},
    {"[::1]:4567", true, true, true},
    {"Car.local:4567", true, true, false},
    {"car.local:4567", true, true, false},  // --allowed by the operator, by name
    {"192.168.1.2:4567", false, true, false},
    {"[fe80::1]:4567", false, true, false},
    {"evil.example", false, false, false},
    {"localhost.evil.example", false, false, false},
    {"127.0.0.1.evil.example:4567", false, false, false},
    {"localhost:evil", false, false, false},
    {"evil.example:4567", false, false, false},
    {"127.evil", false, false, false},
    {"[::1", false, false, false},
    {"", false, false, false},
};

enum class From { kNone, kOwn, kListed, kForeign };
struct Origin {
  const char* text;  ///< "*" stands for the Host
  From from;
};
constexpr Origin kOrigins[] = {
    {"", From::kNone},
    {"http://*", From::kOwn},
    {"https://*", From::kForeign},
    {"https://app.foxglove.dev", From::kListed},
    {"http://app.foxglove.dev", From::kForeign},
    {"https://app.foxglove.dev.evil.example", From::kForeign},
    {"null", From::kForeign},
    {"file://", From::kForeign},
    {"http://evil.example", From::kForeign},
    {"http://*.evil.example", From::kForeign},
    {"http://localhost:8080", From::kForeign},
    {"http://evil.example/*", From::kForeign},
    {"*", From::kForeign},
    {"http://*:8080", From::kForeign},
};

enum class Proof { kNone, kWrongLink, kWrong, kLink, kCookie };
struct Shown {
  const char* query;
  const char* cookies;
  Proof proof;
};
constexpr Shown kProofs[] = {
    {"", "", Proof::kNone},
    {"?token=", "", Proof::kWrongLink},
    {"?token=0123456789abcdefghijklmnopqrstuV", "", Proof::kWrongLink},
    {"?token=0123456789abcdefghijklmnopqrstu", "", Proof::kWrongLink},
    {"?token=wrong", "chicane-4567=0123456789abcdefghijklmnopqrstuv", Proof::kWrongLink},
    {"?tokens=0123456789abcdefghijklmnopqrstuv", "", Proof::kNone},
    {"", "chicane-4567=wrong", Proof::kWrong},
    {"", "chicane-4568=0123456789abcdefghijklmnopqrstuv", Proof::kNone},  // of a program on another port
    {"", "xchicane-4567=0123456789abcdefghijklmnopqrstuv", Proof::kNone},
    {"?token=0123456789abcdefghijklmnopqrstuv", "", Proof::kLink},
    {"?EIO=4&token=0123456789abcdefghijklmnopqrstuv&x=1", "", Proof::kLink},
    {"", "theme=dark; chicane-4567=0123456789abcdefghijklmnopqrstuv", Proof::kCookie},
};

struct Path {
  const char* path;
  bool is_upgrade;
  bool is_page;  ///< a person opens it
};
constexpr Path kPaths[] = {
    {"/", true, false},
    {"/socket.io/", true, false},
    {"/", false, true},
    {"/schema.json", false, false},
    {"/log/0.mcap", false, false},
    {"/app.js", false, false},
};

std::string filled(const char* text, const char* host) {
  std::string all = text;
  if (const std::size_t star = all.find('*'); star != std::string::npos) all.replace(star, 1, host);
  return all;
}

struct Case {
  bool is_lan, has_token;
  const Host& host;
  const Origin& origin;
  const Shown& shown;
  const Path& path;
};

/// As docs/reference/security.md says it.
Admission expected(const Case& of) {
  const auto refused = [](unsigned status) { return Admission{.status = status}; };
  if (!(of.is_lan ? of.host.is_ours_lan : of.host.is_ours)) return refused(403);
  const From from = of.origin.from;
  if (of.path.is_upgrade && from == From::kForeign) return refused(403);
  if (of.has_token && of.shown.proof == Proof::kWrongLink) return refused(403);
  const bool is_proven = !of.has_token || of.shown.proof == Proof::kLink || of.shown.proof == Proof::kCookie;
  const bool is_local = !of.is_lan && of.host.is_loopback;
  const bool may_watch = is_local || is_proven;
  if (!of.path.is_upgrade && (!may_watch || from == From::kForeign)) return refused(403);
  const bool goes_on = of.has_token && of.shown.proof == Proof::kLink && of.path.is_page;
  return {.status = goes_on ? 303U : 200U,
          .may_watch = may_watch,
          .may_control = is_proven || (is_local && from == From::kOwn)};
}

TEST(Admission, IsAsTheTableOfTheDocsSays) {
  int cases = 0;
  for (const bool is_lan : {false, true}) {
    for (const bool has_token : {true, false}) {
      const Doorkeeper door{.address = is_lan ? "0.0.0.0" : "127.0.0.1",
                            .allowed_hosts = {"car.local"},
                            .allowed_origins = {"https://app.foxglove.dev"},
                            .token = has_token ? kToken : "",
                            .port = 4567};
      for (const Host& host : kHosts) {
        for (const Origin& origin : kOrigins) {
          for (const Shown& shown : kProofs) {
            for (const Path& path : kPaths) {
              const std::string from = filled(origin.text, host.text);
              const std::string target = std::string(path.path) + shown.query;
              const Admission got = door.admit({.target = target,
                                                .host = host.text,
                                                .origin = from,
                                                .cookies = shown.cookies,
                                                .hosts = 1,
                                                .is_upgrade = path.is_upgrade});
              const Admission want = expected({is_lan, has_token, host, origin, shown, path});
              SCOPED_TRACE(std::string(is_lan ? "0.0.0.0" : "127.0.0.1") +
                           (has_token ? " token " : " open ") + host.text + " | " + from + " | " + target +
                           " | " + shown.cookies + (path.is_upgrade ? " upgrade" : ""));
              ASSERT_EQ(got.status, want.status) << got.words;
              if (want.status >= 400) {
                EXPECT_FALSE(got.words.empty());
                EXPECT_EQ(got.words.find(kToken), std::string::npos);
              }
              ASSERT_EQ(got.may_watch, want.may_watch);
              ASSERT_EQ(got.may_control, want.may_control);
              ++cases;
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(cases, 2 * 2 * 17 * 14 * 12 * 6);
}

TEST(Admission, ALinkLeadsToItsOwnServerOnly) {
  const Doorkeeper door{.address = "127.0.0.1", .allowed_hosts = {}, .allowed_origins = {}, .token = kToken};
  const auto leads_to = [&](const std::string& path) {
    const std::string target = path + "?token=" + kToken;
    return door.admit({.target = target, .host = "localhost"}).location;
  };
  EXPECT_EQ(leads_to("/"), "/");
  EXPECT_EQ(leads_to("/laps"), "/laps");
  EXPECT_EQ(leads_to("//evil"), "/");
  EXPECT_EQ(leads_to("/\\evil"), "/");
  EXPECT_EQ(leads_to("http://evil"), "/");
  EXPECT_EQ(leads_to(""), "/");
}

}  // namespace
}  // namespace chicane::net
