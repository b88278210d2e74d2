// SPDX-License-Identifier: MIT
#include "chicane/protocol/car_messages.hpp"

#include "protocol/cdr_reader.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

constexpr ServiceCall kCall{.client = 0x1122334455667788, .sequence = 7};

TEST(ParameterMessages, RequestsAreReadAsTheyWereWritten) {
  const auto names =
      test::good(decode<NamesRequest>(encode(NamesRequest{.call = kCall, .names = {"latency_ms", "laps"}})));
  EXPECT_EQ(names->call.client, kCall.client);
  EXPECT_EQ(names->call.sequence, 7);
  EXPECT_THAT(names->names, ElementsAre("latency_ms", "laps"));

  const auto set = test::good(decode<SetRequest>(encode(SetRequest{
      .call = kCall,
      .parameters = {
          {"latency_ms", 50.0}, {"laps", 3.0}, {"controller", std::string("pid")}, {"x", true}}})));
  ASSERT_EQ(set->parameters.size(), 4U);
  EXPECT_EQ(std::get<double>(set->parameters[0].value), 50.0);
  EXPECT_EQ(std::get<double>(set->parameters[1].value), 3.0);  // an integer on the wire
  EXPECT_EQ(std::get<std::string>(set->parameters[2].value), "pid");
  EXPECT_EQ(std::get<bool>(set->parameters[3].value), true);
}

TEST(ParameterMessages, RepliesAreReadAsTheyWereWritten) {
  const auto list = test::good(decode<ListReply>(encode(ListReply{kCall, {"a", "b"}})));
  EXPECT_THAT(list->names, ElementsAre("a", "b"));
  const auto set =
      test::good(decode<SetReply>(encode(SetReply{kCall, {{true, ""}, {false, "out of range"}}})));
  EXPECT_TRUE(set->outcomes[0].is_successful);
  EXPECT_EQ(set->outcomes[1].reason, "out of range");
  const auto get =
      test::good(decode<GetReply>(encode(GetReply{kCall, {{"latency_ms", 20.0}, {"unknown", {}}}})));
  EXPECT_EQ(std::get<double>(get->values[0].value), 20.0);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(get->values[1].value));
}

TEST(ParameterMessages, DescribeWithMeaningAndRange) {
  const std::string bytes = encode(DescribeReply{kCall, {{"latency_ms", 20.0}}});
  test::CdrReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint64_t>(), kCall.client);
  EXPECT_EQ(reader.get<std::int64_t>(), 7);
  EXPECT_EQ(reader.get<std::uint32_t>(), 1U);
  EXPECT_EQ(reader.text(), "latency_ms");
  EXPECT_EQ(reader.get<std::uint8_t>(), 3);  // PARAMETER_DOUBLE
  EXPECT_THAT(reader.text(), testing::EndsWith("[ms]"));
  EXPECT_EQ(reader.text(), "");
  EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  EXPECT_EQ(reader.get<std::uint32_t>(), 1U);
  EXPECT_EQ(reader.number(), 0.0);
  EXPECT_EQ(reader.number(), 500.0);
}

TEST(ParameterMessages, CutAnywhereAreRefused) {
  const std::string bytes = encode(SetRequest{.call = kCall, .parameters = {{"latency_ms", 50.0}}});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode<SetRequest>(std::string_view(bytes).substr(0, size))) << size;
}

}  // namespace
}  // namespace chicane::protocol
