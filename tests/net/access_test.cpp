// SPDX-License-Identifier: MIT
#include "chicane/net/detail/access.hpp"

#include <gtest/gtest.h>

namespace chicane::net {
namespace {

TEST(Access, LoopbackHostsAreAllowedWithAnyPort) {
  for (const char* host :
       {"localhost", "localhost:4567", "LOCALHOST:80", "127.0.0.1:4567", "127.8.8.8", "[::1]:4567"}) {
    EXPECT_TRUE(host_is_allowed(host, "127.0.0.1", {})) << host;
  }
}

TEST(Access, NamesOfStrangersAreRefusedAlsoWhenTheyLookLikeOurs) {
  for (const char* host : {"", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example",
                           "evil.example:4567", "localhost:evil", "[::1", "127.evil", "192.168.1.2"}) {
    EXPECT_FALSE(host_is_allowed(host, "127.0.0.1", {})) << host;
  }
}

TEST(Access, BoundToEverythingNumericAddressesAreAllowedButNoNames) {
  EXPECT_TRUE(host_is_allowed("192.168.1.2:4567", "0.0.0.0", {}));
  EXPECT_TRUE(host_is_allowed("[fe80::1]:4567", "::", {}));
  EXPECT_FALSE(host_is_allowed("rebound.example:4567", "0.0.0.0", {}));
  EXPECT_TRUE(host_is_allowed("Car.local:4567", "0.0.0.0", {"car.local"}));
}

TEST(Access, AnOriginMustBeTheHostItself) {
  EXPECT_TRUE(origin_is_allowed("http://localhost:4567", "localhost:4567", {}));
  EXPECT_FALSE(origin_is_allowed("https://localhost:4567", "localhost:4567", {})) << "a server with TLS";
  EXPECT_TRUE(origin_is_allowed("https://car.local", "car.local", {"https://car.local"}));
  for (const char* origin :
       {"http://evil.example", "http://localhost:4567.evil.example", "http://localhost:8080", "null",
        "localhost:4567", "http://evil.example/localhost:4567"}) {
    EXPECT_FALSE(origin_is_allowed(origin, "localhost:4567", {})) << origin;
  }
  EXPECT_TRUE(origin_is_allowed("https://app.foxglove.dev", "localhost:4567", {"https://app.foxglove.dev"}));
}

}  // namespace
}  // namespace chicane::net
