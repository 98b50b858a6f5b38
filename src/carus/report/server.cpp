// SPDX-License-Identifier: Apache-2.0
#include "carus/report/server.hpp"

#include <fmt/format.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <csignal>

#include "carus/core/error.hpp"

namespace carus::report {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;

constexpr auto patience = std::chrono::seconds(30);
constexpr std::uint32_t longest_header = 16 * 1024;

/// A body that shares the bytes of an Answer: blobs are not copied for every request.
struct SharedBody {
  using value_type = std::shared_ptr<const std::string>;
  static std::uint64_t size(const value_type& body) { return body->size(); }
  class writer {
   public:
    using const_buffers_type = asio::const_buffer;
    template <bool isRequest, class Fields>
    writer(const http::header<isRequest, Fields>&, const value_type& body) : body_(*body) {}
    void init(beast::error_code& e) { e = {}; }
    boost::optional<std::pair<const_buffers_type, bool>> get(beast::error_code& e) {
      e = {};
      return {{const_buffers_type(body_.data(), body_.size()), false}};
    }

   private:
    const std::string& body_;
  };
};

/// "localhost:8321", "127.0.0.1", "[::1]:80"
bool names_loopback(beast::string_view host) {
  for (const beast::string_view name : {"localhost", "127.0.0.1", "[::1]"}) {
    if (host.starts_with(name) && (host.size() == name.size() || host[name.size()] == ':')) return true;
  }
  return false;
}

using Request = http::request_parser<http::empty_body>;

http::response<SharedBody> respond(Site& site, const Request::value_type& request, bool loopback) {
  Answer answer;
  const bool known = request.method() == http::verb::get || request.method() == http::verb::head;
  const auto text = [](const char* s) { return std::make_shared<const std::string>(s); };
  if (!known) {
    answer.status = 405, answer.body = text("only GET and HEAD\n");
  } else if (loopback && !names_loopback(request[http::field::host])) {
    answer.status = 403, answer.body = text("this server answers to localhost alone\n");
  } else {
    const auto target = request.target();
    answer = site.get({target.data(), target.size()});
  }
  http::response<SharedBody> r{http::int_to_status(unsigned(answer.status)), request.version()};
  r.set(http::field::server, "carus");
  r.set(http::field::content_type, answer.type);
  r.set(http::field::cache_control, answer.unchanging ? "max-age=31536000, immutable" : "no-store");
  r.set("X-Content-Type-Options", "nosniff");
  if (!known) r.set(http::field::allow, "GET, HEAD");
  r.keep_alive(request.keep_alive() && known);
  r.body() = answer.body;
  r.content_length(answer.body->size());
  return r;
}

/// One connection: read, answer, read again while the other side keeps it alive.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, Site& site, bool loopback)
      : stream_(std::move(socket)), site_(site), loopback_(loopback) {}

  void read() {
    request_.emplace();
    request_->header_limit(longest_header);
    request_->body_limit(0);
    stream_.expires_after(patience);
    http::async_read(stream_, buffer_, *request_, [self = shared_from_this()](beast::error_code e, std::size_t) {
      if (!e) self->write();  // else: closed, silent for too long, or not HTTP
    });
  }

 private:
  void write() {
    const bool head = request_->get().method() == http::verb::head;
    response_.emplace(respond(site_, request_->get(), loopback_));
    serializer_.emplace(*response_);
    stream_.expires_after(patience);
    const auto done = [self = shared_from_this()](beast::error_code e, std::size_t) {
      if (e) return;
      if (self->response_->keep_alive()) return self->read();
      beast::error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    };
    if (head) {
      http::async_write_header(stream_, *serializer_, done);
    } else {
      http::async_write(stream_, *serializer_, done);
    }
  }

  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  Site& site_;
  bool loopback_;
  boost::optional<Request> request_;
  boost::optional<http::response<SharedBody>> response_;
  boost::optional<http::response_serializer<SharedBody>> serializer_;
};

}  // namespace

struct Server::Parts {
  explicit Parts(Site& s) : site(s) {}
  void accept() {
    acceptor.async_accept([this](beast::error_code e, tcp::socket socket) {
      if (!acceptor.is_open()) return;
      if (!e) std::make_shared<Session>(std::move(socket), site, loopback)->read();
      accept();
    });
  }
  Site& site;
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  bool loopback = true;
};

Server::Server(Site& site, const std::string& address, unsigned short port) : parts_(std::make_unique<Parts>(site)) {
  beast::error_code e;
  const auto ip = asio::ip::make_address(address, e);
  if (e) throw InputError(fmt::format("--address {}: is no IP address; allowed e.g. 127.0.0.1, 0.0.0.0", address));
  const tcp::endpoint endpoint(ip, port);
  auto& acceptor = parts_->acceptor;
  acceptor.open(endpoint.protocol(), e);
  if (!e) acceptor.set_option(asio::socket_base::reuse_address(true), e);
  if (!e) acceptor.bind(endpoint, e);
  if (!e) acceptor.listen(asio::socket_base::max_listen_connections, e);
  if (e)
    throw InputError(fmt::format("{}:{}: cannot be listened at ({}); give another --port, 0 for a free one", address,
                                 port, e.message()));
  parts_->loopback = ip.is_loopback();
  parts_->accept();
}

Server::~Server() = default;

unsigned short Server::port() const { return parts_->acceptor.local_endpoint().port(); }

void Server::run(bool on_signals) {
  asio::signal_set signals(parts_->context);
  if (on_signals) {
    signals.add(SIGINT), signals.add(SIGTERM);
    signals.async_wait([this](beast::error_code e, int) {
      if (!e) parts_->context.stop();
    });
  }
  parts_->context.run();
}

void Server::stop() { parts_->context.stop(); }

}  // namespace carus::report
