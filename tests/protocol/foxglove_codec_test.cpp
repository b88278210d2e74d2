// SPDX-License-Identifier: MIT
#include "chicane/protocol/foxglove_codec.hpp"
#include "support/chicane_test.hpp"

#include <nlohmann/json.hpp>

namespace chicane::protocol::foxglove {
namespace {

using namespace std::string_literals;

template <class Message>
Message parsed(std::string_view bytes, bool binary = false) {
  const auto message = parse(bytes, binary);
  EXPECT_TRUE(message) << (message ? "" : message.error().message);
  if (!message || !std::holds_alternative<Message>(*message)) {
    ADD_FAILURE() << "another kind of message: " << bytes;
    return {};
  }
  return std::get<Message>(*message);
}

std::string refusal(std::string_view bytes, bool binary = false) {
  const auto message = parse(bytes, binary);
  EXPECT_FALSE(message) << bytes;
  return message ? "" : message.error().message;
}

TEST(FoxgloveCodec, ReadsSubscriptionsServiceCallsAndWhatAPacedReaderHasRead) {
  const auto message = parsed<Subscribe>(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,"channelId":1}]})");
  ASSERT_EQ(message.subscriptions.size(), 2U);
  EXPECT_EQ(message.subscriptions[0].channel, 3U);
  EXPECT_EQ(message.subscriptions[1].id, 4294967295U);
  EXPECT_EQ(parsed<Unsubscribe>(R"({"op":"unsubscribe","subscriptionIds":[7,8]})").ids,
            (std::vector<std::uint32_t>{7, 8}));
  const auto call = parsed<CallService>("\x02\x05\0\0\0\x01\x02\0\0\x03\0\0\0cdr\0\1\0\0x"s, true);
  EXPECT_EQ(call.service, 5U);
  EXPECT_EQ(call.call, 0x201U);
  EXPECT_EQ(call.encoding, "cdr");
  EXPECT_EQ(call.payload, "\0\1\0\0x"s);
  const auto read = parsed<Received>(R"({"op":"received","bytes":5000000000,"at":17.25})");
  EXPECT_EQ(read.bytes, 5'000'000'000U);
  EXPECT_EQ(read.at, 17.25);
}

TEST(FoxgloveCodec, ReadsAndWritesParametersOfEveryType) {
  const auto message = parsed<SetParameters>(
      R"({"op":"setParameters","id":"r1","parameters":[{"name":"a","value":3},{"name":"b","value":true},
          {"name":"c","value":"x"},{"name":"d","value":[1,2.5]},{"name":"e"}]})");
  EXPECT_EQ(message.request, "r1");
  std::vector<ParameterValue> values;
  for (const Parameter& each : message.parameters) values.push_back(each.value);
  EXPECT_EQ(values, (std::vector<ParameterValue>{3.0, true, "x"s, std::vector{1.0, 2.5}, {}}));
  EXPECT_EQ(nlohmann::json::parse(parameter_values(message.parameters, "r1")),
            nlohmann::json::parse(R"({"op":"parameterValues","id":"r1","parameters":[
              {"name":"a","value":3.0,"type":"float64"},{"name":"b","value":true},{"name":"c","value":"x"},
              {"name":"d","value":[1.0,2.5],"type":"float64_array"},{"name":"e"}]})"));
  EXPECT_FALSE(nlohmann::json::parse(parameter_values({})).contains("id"));
  EXPECT_EQ(parsed<GetParameters>(R"({"op":"getParameters","parameterNames":["a"]})").names,
            std::vector{"a"s});
  EXPECT_TRUE(
      parsed<SubscribeParameters>(R"({"op":"subscribeParameterUpdates","parameterNames":[]})").names.empty());
  EXPECT_EQ(
      parsed<UnsubscribeParameters>(R"({"op":"unsubscribeParameterUpdates","parameterNames":["b"]})").names,
      std::vector{"b"s});
}

TEST(FoxgloveCodec, RefusesInWordsWhatIsWrong) {
  std::string many = R"({"op":"unsubscribe","subscriptionIds":[0)";
  for (std::size_t i = 0; i < kMaxEntries; ++i) many += ",0";
  const std::string range = "expected a whole number from 0 to 4294967295";
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":3}]})",
            "subscriptions.id: got -1, " + range},
           {R"({"op":"subscribe","subscriptions":[{"id":1}]})",
            "subscriptions.channelId: got null, " + range},
           {R"({"op":"subscribe","subscriptions":{}})", "subscriptions: got {}, expected a list"},
           {R"({"op":"unsubscribe","subscriptionIds":[4294967296]})",
            "subscriptionIds: got 4294967296, " + range},
           {R"({"op":"setParameters","parameters":[{"name":"a","value":{"b":1}}]})",
            R"(a: got {"b":1}, expected a finite number, a text, true, false or a list of numbers)"},
           {R"({"op":"setParameters","parameters":[{"value":1}]})",
            "parameters.name: got null, expected a text"},
           {R"({"op":"fetchAsset","uri":"file:///etc/passwd"})",
            R"(op: "fetchAsset" is not offered by this server)"},
           {R"({"op":"received","bytes":-1,"at":0})", "bytes: got -1, expected a whole number of 0 or more"},
           {R"({"op":"received","bytes":1})", "at: got null, expected a finite number"},
           {many + "]}", "subscriptionIds: got 1025 entries, expected at most 1024"},
           {"[]", "a text message must be one JSON object in UTF-8"}})
    EXPECT_EQ(refusal(text), words);
  EXPECT_THAT(refusal("\x02\0\0\0"s, true), HasSubstr("too few"));
  for (const std::string& bytes : {"\x01\0\0\0\0"s, ""s})
    EXPECT_THAT(refusal(bytes, true), HasSubstr("opcode 2"));
  for (const std::string& hostile :
       {""s, "{"s, "null"s, "\"op\""s, "{\"op\":1}"s, "{\"op\":\"\xff\xfe\"}"s, "{\"op\":\"subscribe\"}"s,
        "{\"op\":\"setParameters\",\"parameters\":[{\"name\":\"a\",\"value\":1e999}]}"s,
        "{\"op\":\"setParameters\",\"parameters\":[{\"name\":\"a\",\"value\":[null]}]}"s,
        std::string(60'000, '['),
        "{\"op\":\"getParameters\",\"parameterNames\":[" + std::string(2'000, '1') + "]}"})
    refusal(hostile);
}

TEST(FoxgloveCodec, DescribesItselfItsChannelsAndServices) {
  const auto info =
      nlohmann::json::parse(server_info("chicane", "s1", {.parameters = true, .services = true}));
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["capabilities"], (nlohmann::json{"time", "parameters", "parametersSubscribe", "services"}));
  EXPECT_EQ(info["sessionId"], "s1");
  EXPECT_EQ(nlohmann::json::parse(server_info("chicane", "s1", {}))["capabilities"],
            (nlohmann::json{"time"}));

  const std::array channels{Channel{1, "/odom", "nav_msgs/msg/Odometry", "text"}};
  EXPECT_EQ(nlohmann::json::parse(advertise(channels)),
            nlohmann::json::parse(R"({"op":"advertise","channels":[{"id":1,"topic":"/odom","encoding":"cdr",
              "schemaName":"nav_msgs/msg/Odometry","schema":"text","schemaEncoding":"ros2msg"}]})"));

  const std::array services{Service{2, "/pause", "std_srvs/srv/SetBool", "bool data", "bool success"}};
  const auto service = nlohmann::json::parse(advertise_services(services))["services"][0];
  EXPECT_EQ(service["type"], "std_srvs/srv/SetBool");
  EXPECT_EQ(service["request"]["schema"], "bool data");
  EXPECT_EQ(service["response"]["schemaName"], "std_srvs/srv/SetBool_Response");
}

TEST(FoxgloveCodec, WritesMessagesByteForByte) {
  EXPECT_EQ(message_data(0x01020304, 0x1112131415161718ULL, "xy"),
            "\x01\x04\x03\x02\x01\x18\x17\x16\x15\x14\x13\x12\x11xy"s);
  EXPECT_EQ(time_message(258), "\x02\x02\x01\0\0\0\0\0\0"s);
  const CallService call{5, 9, "cdr", ""};
  EXPECT_EQ(service_response(call, "z"), "\x03\x05\0\0\0\x09\0\0\0\x03\0\0\0cdrz"s);
  EXPECT_EQ(nlohmann::json::parse(service_failure(call, "no"))["callId"], 9);
  EXPECT_EQ(nlohmann::json::parse(heard(17.25, 0.5)),
            (nlohmann::json{{"op", "heard"}, {"at", 17.25}, {"held", 0.5}}));
  EXPECT_THAT(status(StatusLevel::kError, "bad \xff byte"), HasSubstr("\"level\":2")) << "not UTF-8";
}

}  // namespace
}  // namespace chicane::protocol::foxglove
