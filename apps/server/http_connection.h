#pragma once
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <memory>
#include <optional>

#include "server/access.h"
#include "server/reply.h"
#include "server/routes.h"
#include "server/target.h"
#include "server/uploads.h"

namespace voxlume::server {

/// What connections share.
struct ServerParts {
  const Access& access;
  SharedView& view;
  const Routes& routes;
  Uploads& uploads;
  std::size_t most_viewers = 64;
};

/// A TCP connection: HTTP requests one after the other, until one becomes a WebSocket.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  /// `token` lives as long as the connection; the listener counts by it.
  HttpConnection(boost::beast::tcp_stream stream, ServerParts parts, std::shared_ptr<void> token);

  void read();

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;
  using UploadParser = boost::beast::http::request_parser<boost::beast::http::file_body>;
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  void answer();
  std::optional<Reply> refusal(const Request& request, const Target& target) const;
  void get(const Target& target);
  void put(const Target& target);
  void go_ahead();
  void read_upload();
  void finish_upload();
  void become_viewer();
  void reply(Reply reply, bool keep_open);
  template <class Body>
  void send(std::shared_ptr<boost::beast::http::response<Body>> response, std::shared_ptr<Reply> reply);
  template <class Serializer>
  void send_more(std::shared_ptr<Serializer> serializer, std::shared_ptr<void> owner, bool keep_open);
  void close();
  void drain();

  boost::beast::tcp_stream stream_;
  const ServerParts parts_;
  const std::shared_ptr<void> token_;
  boost::beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  std::optional<UploadParser> upload_parser_;
  std::unique_ptr<Uploads::Incoming> upload_;
};

}  // namespace voxlume::server
