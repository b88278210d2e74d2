// SPDX-License-Identifier: MIT
// HTTP and WebSocket server over Boost.Beast, which no other file includes: accepts connections, reads
// requests, answers them or upgrades them to WebSockets, and writes the messages that wait for each.
#include "chicane/net/server.hpp"

#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <array>
#include <list>
#include <thread>
#include <unordered_map>

#include <fmt/format.h>

#include "chicane/net/detail/connections.hpp"

namespace chicane::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using ErrorCodeBoost = boost::system::error_code;
std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }
boost::string_view view(std::string_view text) { return {text.data(), text.size()}; }

// Chosen, none of them is critical:
constexpr int kSendBuffer = 32 * 1024;                  // [byte] of the kernel for a reader that stalls
constexpr std::chrono::seconds kAnswerTimeout{30};      // limit for one piece of an answer on a slow line
constexpr std::chrono::seconds kLingerTimeout{1};       // time for the client to read a refusal
constexpr std::chrono::milliseconds kAcceptPause{100};  // after a failure, as when descriptors are used up
constexpr std::size_t kKeptBuffer = 4096;               // [byte] buffer kept between two messages
constexpr std::size_t kMostReserved = 8;                // connections that viewers leave to others
constexpr std::size_t kLongestReason = 120;             // [byte] of a close frame; RFC 6455 allows 123

class WebSocket;
class HttpConnection;

/// Whether a request names gzip among the encodings that it accepts (RFC 9110, section 12.5.3).
bool accepts_gzip(const http::request<http::empty_body>& request) {
  const auto accepted = request[http::field::accept_encoding];
  return http::ext_list{accepted}.exists("gzip") || http::ext_list{accepted}.exists("*");
}

/// State of the server that its connections share. Used on the network thread alone.
struct Core {
  ServerOptions options;
  ServerHandlers handlers;
  Site site{};
  std::shared_ptr<int> ticket = std::make_shared<int>(0);  ///< copied by each connection: counts open sockets
  Doorkeeper door{};
  WaitingBytes waiting{};
  std::list<HttpConnection*> visitors{};  ///< connections without an upgrade, longest silent first
  std::unordered_map<ConnectionId, std::shared_ptr<WebSocket>> connections;  ///< upgraded connections
  ConnectionId next_id = 1;
  bool is_stopping = false;
  asio::io_context io{1};  ///< last member: its handlers use the others when it ends

  /// Number of open sockets.
  [[nodiscard]] std::size_t open() const { return static_cast<std::size_t>(ticket.use_count()) - 1; }
  /// Whether the connections left are reserved for others than viewers.
  [[nodiscard]] bool is_crowded() const {
    return connections.size() + std::min(kMostReserved, options.max_connections / 8) >=
           options.max_connections;
  }
};

/// One upgraded connection. A read is pending from open() to end(), and the connection ends only where that
/// read completes with an error.
class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(Core& core, Tcp::socket socket, int endpoint, ConnectionId id)
      : core_{core}, ticket_{core.ticket}, stream_{std::move(socket)}, endpoint_{endpoint}, id_{id} {}
  ~WebSocket() { queue_.drop_waiting(false); }

  /// Answers the upgrade; open() follows.
  void start(const http::request<http::empty_body>& request, const std::string& subprotocol) {
    stream_.set_option(
        websocket::stream_base::timeout{core_.options.handshake_timeout, core_.options.idle_timeout, true});
    stream_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& answer) {
      answer.set(http::field::server, "chicane");
      answer.set(http::field::connection, "Upgrade");
      if (!subprotocol.empty()) answer.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    stream_.read_message_max(core_.options.max_message);
    stream_.auto_fragment(false);
    stream_.control_callback([this](websocket::frame_type kind, boost::string_view) {
      has_peer_closed_ |= kind == websocket::frame_type::close;
    });
    stream_.async_accept(request, [self = shared_from_this()](ErrorCodeBoost ec) {
      if (!ec) self->open();
    });
  }

  /// Queues a message, or ends the connection if too much waits for it.
  void send(Outgoing message) {
    if (is_closing_) return;
    const bool is_full = !queue_.add(std::move(message), is_writing_, core_.options.max_queue);
    const std::size_t all = core_.waiting.total();
    const bool has_more_than_mean = queue_.bytes() * core_.connections.size() >= all;
    if (is_full || (all > core_.options.max_waiting && has_more_than_mean))
      return abort("does not read what it is sent");
    if (!is_writing_) write();
  }

  [[nodiscard]] const SendQueue& queue() const { return queue_; }

  /// Sends a close frame once the queue is written.
  void close(std::uint16_t code, std::string_view reason) {
    if (is_closing_) return;
    is_closing_ = true;
    close_reason_ = {static_cast<websocket::close_code>(code), view(reason.substr(0, kLongestReason))};
    if (why_.empty()) why_ = reason;
    if (!is_writing_) finish_closing();
  }

 private:
  void open() {
    if (core_.is_stopping) return;
    core_.connections.emplace(id_, shared_from_this());
    core_.handlers.on_open(id_, endpoint_);
    read();
  }

  /// Reads messages until the connection ends.
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](ErrorCodeBoost ec, std::size_t) {
      if (ec) return self->end(ec);
      if (!self->is_closing_ && !self->core_.is_stopping) {
        const auto bytes = self->buffer_.data();
        self->core_.handlers.on_message(self->id_, self->endpoint_,
                                        {static_cast<const char*>(bytes.data()), bytes.size()},
                                        self->stream_.got_binary());
      }
      self->buffer_.consume(self->buffer_.size());
      if (self->buffer_.capacity() > kKeptBuffer) self->buffer_.shrink_to_fit();
      self->read();
    });
  }

  /// Writes queued messages one after another, then the close frame if close() was called.
  void write() {
    is_writing_ = true;
    stream_.binary(queue_.front().binary);
    stream_.async_write(asio::buffer(*queue_.front().bytes),
                        [self = shared_from_this()](ErrorCodeBoost ec, std::size_t) {
                          self->is_writing_ = false;
                          self->queue_.pop();
                          if (ec) return self->abort(ec.message());
                          if (!self->queue_.empty()) return self->write();
                          if (self->is_closing_) self->finish_closing();
                        });
  }

  void finish_closing() {
    stream_.async_close(close_reason_, [self = shared_from_this()](ErrorCodeBoost) {});
  }

  /// Ends without a close frame; the pending read completes.
  void abort(std::string why) {
    if (why_.empty()) why_ = std::move(why);
    is_closing_ = true;
    queue_.drop_waiting(is_writing_);
    beast::get_lowest_layer(stream_).close();
  }

  /// Forgets the connection, whose read ended with `ec`, and calls on_close.
  void end(ErrorCodeBoost ec) {
    is_closing_ = true;
    if (why_.empty()) why_ = reason_of(ec);
    core_.connections.erase(id_);
    if (!core_.is_stopping) return core_.handlers.on_close(id_, endpoint_, why_);
    if (core_.connections.empty()) core_.io.stop();
  }

  /// Reason for on_close of a read that ended with `ec`.
  [[nodiscard]] std::string reason_of(ErrorCodeBoost ec) const {
    if (has_peer_closed_ || ec == websocket::error::closed)
      return fmt::format("closed by the peer ({})", stream_.reason().code);
    if (ec == websocket::error::message_too_big)
      return fmt::format("sent a message of more than {} bytes", core_.options.max_message);
    if (ec == beast::error::timeout)
      return fmt::format("silent for {} ms", core_.options.idle_timeout.count());
    if (ec == asio::error::bad_descriptor) return "broke a rule and did not hang up when asked";
    return ec == asio::error::eof ? "connection ended without a close frame" : ec.message();
  }

  Core& core_;
  std::shared_ptr<int> ticket_;                         ///< copy of Core::ticket
  websocket::stream<beast::tcp_stream, false> stream_;  ///< without compression
  beast::flat_buffer buffer_;                           ///< message being read
  int endpoint_;                                        ///< UpgradeAnswer::endpoint
  ConnectionId id_;
  SendQueue queue_{core_.waiting};
  bool is_writing_ = false;               ///< the front of queue_ is being written
  bool is_closing_ = false;               ///< nothing more is queued or passed to on_message
  bool has_peer_closed_ = false;          ///< a close frame has arrived
  websocket::close_reason close_reason_;  ///< content of the close frame
  std::string why_;                       ///< reason for on_close: the first one that arose
};

/// One connection before (or without) an upgrade.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Core& core, Tcp::socket socket)
      : core_{core}, ticket_{core.ticket}, stream_{std::move(socket)} {}

  ~HttpConnection() { core_.visitors.erase(place_); }

  void start() {
    if (core_.open() > core_.options.max_connections) {
      if (core_.visitors.size() < 2) return refuse(http::status::service_unavailable, "too many connections");
      core_.visitors.front()->give_way();
    }
    read();
  }

 private:
  /// Closes the connection, whose place a new one needs.
  void give_way() {
    core_.visitors.splice(core_.visitors.end(), core_.visitors, place_);  // not to be chosen again
    stream_.close();
  }

  /// Reads one request and answers it.
  void read() {
    core_.visitors.splice(core_.visitors.end(), core_.visitors, place_);
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(core_.options.max_header));
    parser_->body_limit(0);
    stream_.expires_after(core_.options.handshake_timeout);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](ErrorCodeBoost ec, std::size_t) {
      if (!ec) return self->answer(self->parser_->get());
      if (ec == http::error::header_limit || ec == http::error::buffer_overflow) {
        return self->refuse(http::status::request_header_fields_too_large,
                            "the request's header is too large");
      }
      if (ec == http::error::end_of_stream || ec == http::error::partial_message) return;
      if (ec.category() == make_error_code(http::error::bad_method).category())
        self->refuse(http::status::bad_request, "not an HTTP request: " + ec.message());
    });
  }

  /// Upgrades, redirects, serves or refuses, as the access rules decide.
  void answer(const http::request<http::empty_body>& request) {
    host_ = view(request[http::field::host]);
    const Admission admission = core_.door.admit({.target = view(request.target()),
                                                  .host = host_,
                                                  .origin = view(request[http::field::origin]),
                                                  .cookies = view(request[http::field::cookie]),
                                                  .hosts = request.count(http::field::host),
                                                  .is_upgrade = websocket::is_upgrade(request)});
    if (admission.status == 200 && websocket::is_upgrade(request)) return upgrade(request, admission);
    const bool is_get = request.method() == http::verb::get || request.method() == http::verb::head;
    if (admission.status < 400 && !is_get)
      return refuse(http::status::method_not_allowed, "only GET and HEAD");
    if (admission.status == 303)
      return reply(HttpResponse::see_other(admission.location, core_.door.cookie()), {});
    if (admission.status == 200) {
      const auto& why = core_.handlers.on_no_upgrade;
      std::string words = why ? why(view(request.target())) : "";
      return words.empty() ? serve(request) : turn_away(http::status::bad_request, std::move(words));
    }
    turn_away(http::int_to_status(admission.status), admission.words);
  }

  /// Asks the program about an upgrade, and hands the socket over to a WebSocket if it accepts.
  void upgrade(const http::request<http::empty_body>& request, const Admission& admission) {
    if (buffer_.size() > 0)
      return refuse(http::status::bad_request, "bytes sent before the upgrade was answered");
    ErrorCodeBoost ignored;
    const auto peer = stream_.socket().remote_endpoint(ignored);
    UpgradeRequest asked{.id = core_.next_id++,
                         .target = std::string(view(request.target())),
                         .peer = fmt::format("{}:{}", peer.address().to_string(ignored), peer.port()),
                         .origin = std::string(view(request[http::field::origin])),
                         .host = host_,
                         .subprotocols = {},
                         .may_watch = admission.may_watch,
                         .may_control = admission.may_control,
                         .is_crowded = core_.is_crowded()};
    for (const auto offered : http::token_list(request[http::field::sec_websocket_protocol]))
      asked.subprotocols.emplace_back(view(offered));
    const UpgradeAnswer answer = core_.handlers.on_upgrade(asked);
    if (!answer.accept)
      return refuse(http::int_to_status(static_cast<unsigned>(answer.status)), answer.reason);
    stream_.expires_never();
    std::make_shared<WebSocket>(core_, stream_.release_socket(), answer.endpoint, asked.id)
        ->start(request, answer.subprotocol);
  }

  /// Answers a GET or HEAD with a content of the site.
  void serve(const http::request<http::empty_body>& request) {
    const HttpRequest asked{.is_head = request.method() == http::verb::head,
                            .keep_alive = request.keep_alive(),
                            .accepts_gzip = accepts_gzip(request),
                            .range = view(request[http::field::range]),
                            .if_range = view(request[http::field::if_range]),
                            .if_none_match = view(request[http::field::if_none_match])};
    reply(core_.site.answer(view(request.target()), asked), asked);
  }

  /// Refuses a request by a rule that the operator can change; reports it by on_refused.
  void turn_away(http::status status, std::string words) {
    ErrorCodeBoost ignored;
    const std::string peer = stream_.socket().remote_endpoint(ignored).address().to_string(ignored);
    if (const auto& tell = core_.handlers.on_refused) tell(peer, words);
    refuse(status, std::move(words));
  }

  /// Answers in words and ends the connection.
  void refuse(http::status status, std::string words) {
    auto response = HttpResponse::in_words(
        fmt::format("{} {}", static_cast<unsigned>(status), view(http::obsolete_reason(status))),
        std::move(words));
    if (status == http::status::method_not_allowed) response.add("Allow", "GET, HEAD");
    reply(std::move(response), {});
  }

  void reply(HttpResponse response, const HttpRequest& asked) {
    piece_ = response.head(asked, host_);
    body_ = asked.is_head ? Body{} : std::move(response.body());
    write(asked.keep_alive);
  }

  /// Writes the answer piece by piece, then reads the next request or ends.
  void write(bool keep_alive) {
    stream_.expires_after(kAnswerTimeout);
    asio::async_write(stream_, asio::buffer(piece_),
                      [self = shared_from_this(), keep_alive](ErrorCodeBoost ec, std::size_t) {
                        if (ec) return;
                        if (self->body_.next(self->piece_)) return self->write(keep_alive);
                        if (self->body_.is_short()) return;  // body shorter than announced
                        if (keep_alive) return self->read();
                        self->linger();
                      });
  }

  /// Half-closes and reads on until the peer has closed, too: a reset at once could discard the answer.
  void linger() {
    ErrorCodeBoost ignored;
    stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kLingerTimeout);
    drain();
  }

  void drain() {
    stream_.async_read_some(asio::buffer(rest_), [self = shared_from_this()](ErrorCodeBoost ec, std::size_t) {
      if (!ec) self->drain();
    });
  }

  Core& core_;
  std::shared_ptr<int> ticket_;  ///< copy of Core::ticket
  beast::tcp_stream stream_;
  /// Place of this connection in Core::visitors.
  std::list<HttpConnection*>::iterator place_ = core_.visitors.insert(core_.visitors.end(), this);
  beast::flat_buffer buffer_{core_.options.max_header + 2 * kKeptBuffer};
  std::optional<http::request_parser<http::empty_body>> parser_;  ///< parser of one request
  std::array<char, 1024> rest_{};                                 ///< bytes that linger() throws away
  std::string host_;                                              ///< Host header of the last request
  std::string piece_;                                             ///< part of the answer being written
  Body body_;                                                     ///< rest of the answer
};

class BeastServer final : public Server {
 public:
  BeastServer(const ServerOptions& options, ServerHandlers handlers, std::vector<Asset> assets) {
    core_.options = options;
    core_.handlers = std::move(handlers);
    core_.site = Site(std::move(assets), core_.handlers.on_get);
  }

  ~BeastServer() override {
    if (!thread_.joinable()) return;
    asio::post(core_.io, [this] { say_goodbye(); });
    thread_.join();
    core_.connections.clear();
  }

  /// Checks the address, listens, and starts the network thread.
  Result<void> start() {
    ErrorCodeBoost ec;
    const auto address = asio::ip::make_address(core_.options.address, ec);
    if (ec)
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("address: got '{}', expected a numeric address", core_.options.address));
    if (!address.is_loopback() && core_.options.token.empty())
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("address: got {} without a token, expected one of this machine or a token: all "
                              "who reach it could drive",
                              core_.options.address));
    const Tcp::endpoint endpoint{address, core_.options.port};
    acceptor_.open(endpoint.protocol(), ec);
    if (!ec) acceptor_.set_option(asio::socket_base::reuse_address(true), ec);
    if (!ec && address == asio::ip::address{asio::ip::address_v6::any()})
      acceptor_.set_option(asio::ip::v6_only(false), ec);
    if (!ec) acceptor_.bind(endpoint, ec);
    if (!ec) acceptor_.listen(asio::socket_base::max_listen_connections, ec);
    if (ec)
      return fail(cannot_listen(core_.options.address, core_.options.port, ec == asio::error::address_in_use,
                                ec.message()));
    port_ = acceptor_.local_endpoint(ec).port();
    const ServerOptions& o = core_.options;
    core_.door = {o.address, o.allowed_hosts, o.allowed_origins, o.token, port_};
    asio::post(core_.io, [this] {
      if (core_.handlers.on_start) core_.handlers.on_start(*this);
      accept();
    });
    thread_ = std::thread([this] { core_.io.run(); });
    return {};
  }

  [[nodiscard]] std::uint16_t port() const noexcept override { return port_; }

  using Server::send;
  void send(ConnectionId to, Bytes bytes, bool binary, Delivery delivery, std::uint32_t topic) override {
    asio::dispatch(core_.io,
                   [this, to, message = Outgoing{std::move(bytes), binary, delivery, topic}]() mutable {
                     const auto found = core_.connections.find(to);
                     if (found != core_.connections.end()) found->second->send(std::move(message));
                   });
  }

  [[nodiscard]] std::size_t waiting(ConnectionId id) const override {
    return core_.connections.contains(id) ? core_.connections.at(id)->queue().size() : 0;
  }

  void close(ConnectionId id, std::uint16_t code, std::string_view reason) override {
    asio::dispatch(core_.io, [this, id, code, text = std::string(reason)] {
      const auto found = core_.connections.find(id);
      if (found != core_.connections.end()) found->second->close(code, text);
    });
  }

  void run_after(std::chrono::nanoseconds delay, std::function<void()> task) override {
    auto checked = [this, task = std::move(task)] {
      if (!core_.is_stopping) task();
    };
    if (delay.count() <= 0) return asio::post(core_.io, std::move(checked));
    auto timer = std::make_shared<asio::steady_timer>(core_.io, delay);
    timer->async_wait([timer, checked = std::move(checked)](ErrorCodeBoost ec) {
      if (!ec) checked();
    });
  }

 private:
  void accept() {
    acceptor_.async_accept([this](ErrorCodeBoost ec, Tcp::socket socket) {
      if (core_.is_stopping) return;
      if (ec) return run_after(kAcceptPause, [this] { accept(); });
      ErrorCodeBoost ignored;
      socket.set_option(Tcp::no_delay(true), ignored);
      socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
      std::make_shared<HttpConnection>(core_, std::move(socket))->start();
      accept();
    });
  }

  /// Stops accepting, closes all WebSockets, and ends the network thread when they have closed or after the
  /// time `goodbye`.
  void say_goodbye() {
    core_.is_stopping = true;
    ErrorCodeBoost ignored;
    acceptor_.close(ignored);
    if (core_.connections.empty()) return core_.io.stop();
    for (const auto& [id, connection] : core_.connections) connection->close(1001, "the program ends");
    auto timer = std::make_shared<asio::steady_timer>(core_.io, core_.options.goodbye);
    timer->async_wait([this, timer](ErrorCodeBoost) { core_.io.stop(); });
  }

  Core core_;
  Tcp::acceptor acceptor_{core_.io};
  std::uint16_t port_ = 0;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<Server>> Server::create(const ServerOptions& options, ServerHandlers handlers,
                                               std::vector<Asset> assets) {
  auto server = std::make_unique<BeastServer>(options, std::move(handlers), std::move(assets));
  if (auto started = server->start(); !started) return fail(started.error());
  return server;
}

}  // namespace chicane::net
