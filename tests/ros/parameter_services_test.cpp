// SPDX-License-Identifier: MIT
#include "chicane/ros/run_publisher.hpp"

#include "chicane/protocol/car_messages.hpp"
#include "support/chicane_test.hpp"

namespace chicane::ros {
namespace {

using protocol::foxglove::Parameter;

class Store : public protocol::foxglove::ParameterStore {
 public:
  [[nodiscard]] std::vector<Parameter> list() const override {
    return {{"latency_ms", latency_}, {"pid.gain", 1.0}};
  }
  [[nodiscard]] std::optional<Parameter> get(std::string_view name) const override {
    if (name != "latency_ms") return std::nullopt;
    return Parameter{"latency_ms", latency_};
  }
  Result<void> set(const Parameter& parameter) override {
    if (parameter.name != "latency_ms") return fail(ErrorCode::kInvalidArgument, "unknown key");
    latency_ = std::get<double>(parameter.value);
    return {};
  }

 private:
  double latency_ = 100.0;
};

/// A client of the services, in the same domain and process.
class ParameterServicesTest : public testing::Test {
 protected:
  static constexpr int kDomain = 73;
  void SetUp() override {
    auto node = test::good(Participant::create({.domain = kDomain}));
    node_ = std::move(*node);
    auto services =
        ParameterServices::create(*node_, store_, [](const std::function<void()>& task) { task(); });
    ASSERT_TRUE(services);
    services_ = std::move(*services);
  }
  std::string ask(const std::string& service, const std::string& type, const std::string& request) {
    auto writer =
        node_->writer("rq/chicane/" + service + "Request", "rcl_interfaces/srv/" + type + "_Request", {});
    auto reader =
        node_->reader("rr/chicane/" + service + "Reply", "rcl_interfaces/srv/" + type + "_Response", {});
    EXPECT_TRUE(writer && reader);
    (*writer)->write(request);
    for (int i = 0; i < 100; ++i) {
      node_->wait(std::chrono::milliseconds{20});
      services_->serve();
      const auto replies = (*reader)->take();
      if (!replies.empty()) return replies[0].bytes;
    }
    return {};
  }

  Store store_;
  std::unique_ptr<Participant> node_;
  std::unique_ptr<ParameterServices> services_;
};

TEST_F(ParameterServicesTest, ListsByPrefix) {
  const auto reply = test::good(protocol::decode<protocol::ListReply>(
      ask("list_parameters", "ListParameters", encode(protocol::NamesRequest{.names = {"pid"}}))));
  EXPECT_THAT(reply->names, ElementsAre("pid.gain"));
}

TEST_F(ParameterServicesTest, SetsAndGets) {
  const auto set = test::good(protocol::decode<protocol::SetReply>(
      ask("set_parameters", "SetParameters",
          encode(protocol::SetRequest{.parameters = {{"latency_ms", 30.0}, {"latency", 30.0}}}))));
  ASSERT_EQ(set->outcomes.size(), 2U);
  EXPECT_TRUE(set->outcomes[0].is_successful);
  EXPECT_EQ(set->outcomes[1].reason, "unknown key");
  const auto get = test::good(protocol::decode<protocol::GetReply>(ask(
      "get_parameters", "GetParameters", encode(protocol::NamesRequest{.names = {"latency_ms", "none"}}))));
  EXPECT_EQ(std::get<double>(get->values[0].value), 30.0);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(get->values[1].value));
}

}  // namespace
}  // namespace chicane::ros
