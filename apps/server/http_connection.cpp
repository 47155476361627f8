#include "server/http_connection.h"

#include <boost/asio/dispatch.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include <algorithm>
#include <limits>

#include "server/viewer.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using Status = Reply::Status;

namespace {

constexpr std::uint32_t kMostHeaderBytes = 16 << 10;
constexpr auto kIdle = std::chrono::seconds(30);
constexpr auto kFarewell = std::chrono::seconds(3);

std::string_view text(beast::string_view view) { return {view.data(), view.size()}; }

template <class Request, class Name>
std::string_view field(const Request& request, Name name) {
  const auto found = request.find(name);
  return found == request.end() ? std::string_view() : text(found->value());
}

Reply upload_refusal(const std::exception& reason) {
  const auto* error = dynamic_cast<const Error*>(&reason);
  const bool wrong = error != nullptr && error->code() == ErrorCode::kBadParameter;
  const bool too_many = error != nullptr && error->code() == ErrorCode::kUnsupported;
  return error_reply(wrong      ? Status::bad_request
                     : too_many ? Status::payload_too_large
                                : Status::service_unavailable,
                     reason.what());
}

template <class Message>
void add_headers(Message& message, const Reply& reply) {
  message.set(http::field::content_type, reply.type);
  message.set("X-Content-Type-Options", "nosniff");
  message.set("X-Frame-Options", "DENY");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set(http::field::cache_control, "no-store");
  for (const auto& [name, value] : reply.headers) message.set(name, value);
}

}  // namespace

HttpConnection::HttpConnection(beast::tcp_stream stream, ServerParts parts, std::shared_ptr<void> token)
    : stream_(std::move(stream)), parts_(parts), token_(std::move(token)) {}

void HttpConnection::read() {
  parser_.emplace();
  parser_->header_limit(kMostHeaderBytes);
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // refused or limited later
  stream_.expires_after(kIdle);
  http::async_read_header(stream_, buffer_, *parser_,
                          [self = shared_from_this()](error_code failed, std::size_t) {
                            if (!failed) return self->answer();
                            if (failed == http::error::end_of_stream || failed == beast::error::timeout ||
                                failed == boost::asio::error::connection_reset)
                              return self->close();
                            self->reply(error_reply(Status::bad_request, "expected an HTTP request"), false);
                          });
}

void HttpConnection::answer() {
  const Request& request = parser_->get();
  const auto target = parse_target(text(request.target()));
  if (!target) return reply(error_reply(Status::bad_request, "the address cannot be read"), false);
  if (auto refused = refusal(request, *target)) return reply(std::move(*refused), false);
  if (beast::websocket::is_upgrade(request)) {
    if (target->path != "/api/socket")
      return reply(error_reply(Status::not_found, "there is no such socket"), false);
    return become_viewer();
  }
  if (request.method() == http::verb::put) return put(*target);
  if (request.method() != http::verb::get)
    return reply(error_reply(Status::bad_request, "expected GET, or PUT of an upload"), false);
  if (!parser_->is_done() && (parser_->chunked() || parser_->content_length().value_or(0) > 0))
    return reply(error_reply(Status::bad_request, "expected a request without a body"), false);
  get(*target);
}

std::optional<Reply> HttpConnection::refusal(const Request& request, const Target& target) const {
  const std::string_view host = field(request, http::field::host);
  if (!parts_.access.is_host(host) || request.count(http::field::host) != 1)
    return error_reply(Status::forbidden, "this viewer has another address; open the one that it printed");
  const bool foreign =
      request.count(http::field::origin) > 0 && !is_same_origin(field(request, http::field::origin), host);
  if (foreign || !may_ask(field(request, "Sec-Fetch-Site"), target.path))
    return error_reply(Status::forbidden, "another site's page may not ask this viewer");
  if (request.method() == http::verb::get && target.path == "/" && target.query.contains("token") &&
      parts_.access.is_token(target.value("token"))) {
    Reply reply;
    reply.status = Status::see_other;
    reply.headers = {{"Location", "/"}, {"Set-Cookie", parts_.access.set_cookie()}};
    return reply;
  }
  if (!parts_.access.has_cookie(field(request, http::field::cookie)))
    return error_reply(Status::forbidden,
                       "open the address with ?token= that voxlume view printed in its terminal");
  return std::nullopt;
}

void HttpConnection::get(const Target& target) {
  stream_.expires_never();  // some answers take long
  const bool keep_open = parser_->get().keep_alive();
  const std::string if_none_match(field(parser_->get(), http::field::if_none_match));
  parts_.routes.get(target, if_none_match, [self = shared_from_this(), keep_open](Reply reply) {
    boost::asio::dispatch(
        self->stream_.get_executor(),
        [self, keep_open, reply = std::move(reply)]() mutable { self->reply(std::move(reply), keep_open); });
  });
}

void HttpConnection::put(const Target& target) {
  if (target.path != "/api/upload")
    return reply(error_reply(Status::not_found, "there is no such request"), false);
  std::optional<UploadSet> set;
  if (target.query.contains("set")) set = {target.value("set"), target.value("folder")};
  try {
    upload_ = parts_.uploads.begin(target.value("name"), set);
  } catch (const std::exception& error) {
    return reply(upload_refusal(error), false);
  }
  const std::uint64_t room = parts_.uploads.room(), wanted = parser_->content_length().value_or(room);
  upload_->reserve(std::min(wanted, room));
  if (wanted > room) {
    upload_.reset();
    return reply(error_reply(Status::payload_too_large, "there is no room for a file of that size"), false);
  }
  const bool expects = beast::iequals(parser_->get()[http::field::expect], "100-continue");
  upload_parser_.emplace(std::move(*parser_));
  upload_parser_->body_limit(wanted);
  error_code failed;
  upload_parser_->get().body().open(upload_->path().c_str(), beast::file_mode::write_new, failed);
  if (failed) {
    upload_.reset();
    return reply(error_reply(Status::service_unavailable, failed.message()), false);
  }
  expects ? go_ahead() : read_upload();
}

/// Whoever sends a large file may wait for this first.
void HttpConnection::go_ahead() {
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  stream_.expires_after(kIdle);
  boost::asio::async_write(stream_, boost::asio::buffer(kContinue),
                           [self = shared_from_this()](error_code failed, std::size_t) {
                             failed ? self->close() : self->read_upload();
                           });
}

void HttpConnection::read_upload() {
  if (upload_parser_->is_done()) return finish_upload();
  stream_.expires_after(kIdle);
  http::async_read_some(
      stream_, buffer_, *upload_parser_, [self = shared_from_this()](error_code failed, std::size_t) {
        if (!failed) return self->read_upload();
        self->upload_.reset();
        if (failed == http::error::body_limit)
          return self->reply(error_reply(Status::payload_too_large, "the file is too large"), false);
        if (failed.category() == boost::system::generic_category())
          return self->reply(error_reply(Status::service_unavailable, failed.message()), false);
        self->close();
      });
}

void HttpConnection::finish_upload() {
  const bool keep_open = upload_parser_->get().keep_alive();
  upload_parser_->get().body().close();
  Reply answer;
  try {
    answer = json_reply(text_of({{"path", upload_->finish().string()}}));
  } catch (const std::exception& error) {
    answer = upload_refusal(error);
  }
  upload_.reset();
  upload_parser_.reset();
  reply(std::move(answer), keep_open);
}

void HttpConnection::become_viewer() {
  if (parts_.view.viewer_count() >= parts_.most_viewers)
    return reply(error_reply(Status::service_unavailable, "too many pages are connected"), false);
  std::make_shared<Viewer>(std::move(stream_), parts_.view, token_)->accept(parser_->get());
}

void HttpConnection::reply(Reply reply, bool keep_open) {
  const auto kept = std::make_shared<Reply>(std::move(reply));
  const auto start = [&](auto& message) {
    message.version(11);
    message.result(kept->status);
    message.keep_alive(keep_open);
    add_headers(message, *kept);
  };
  if (kept->file.empty()) {
    // The body is not copied: a span of what `kept` owns.
    auto message = std::make_shared<http::response<http::span_body<const char>>>();
    start(*message);
    message->body() = {kept->body->data(), kept->body->size()};
    if (kept->status != Status::not_modified) message->prepare_payload();
    return send(message, kept);
  }
  auto message = std::make_shared<http::response<http::file_body>>();
  error_code failed;
  message->body().open(kept->file.c_str(), beast::file_mode::scan, failed);
  if (failed) return this->reply(error_reply(Status::not_found, "the file is not there any more"), keep_open);
  start(*message);
  message->prepare_payload();
  send(message, kept);
}

template <class Body>
void HttpConnection::send(std::shared_ptr<http::response<Body>> response, std::shared_ptr<Reply> reply) {
  if (reply->remove_file) {  // what is open can still be read
    std::error_code ignored;
    std::filesystem::remove(reply->file, ignored);
  }
  struct Owned {
    std::shared_ptr<Reply> reply;
    std::shared_ptr<http::response<Body>> response;
  };
  auto serializer = std::make_shared<http::response_serializer<Body>>(*response);
  send_more(serializer, std::make_shared<Owned>(Owned{reply, response}), response->keep_alive());
}

template <class Serializer>
void HttpConnection::send_more(std::shared_ptr<Serializer> serializer, std::shared_ptr<void> owner,
                               bool keep_open) {
  stream_.expires_after(kIdle);
  http::async_write_some(
      stream_, *serializer,
      [self = shared_from_this(), serializer, owner, keep_open](error_code failed, std::size_t) {
        if (failed) return self->close();
        if (!serializer->is_done()) return self->send_more(serializer, owner, keep_open);
        keep_open ? self->read() : self->close();
      });
}

void HttpConnection::close() {
  error_code ignored;
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  stream_.expires_after(kFarewell);
  drain();
}

/// What is still on its way is read and dropped: closing before would take the answer back from those who
/// send before they read.
void HttpConnection::drain() {
  buffer_.clear();
  stream_.async_read_some(buffer_.prepare(1 << 16),
                          [self = shared_from_this()](error_code failed, std::size_t) {
                            if (!failed) self->drain();
                          });
}

}  // namespace voxlume::server
