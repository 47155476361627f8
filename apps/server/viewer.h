#pragma once
#include <array>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/frame_message.h"

namespace voxlume::server {

class SharedView;

/// Messages a second, on average; short runs of more are let through.
class RateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  RateLimit(double per_second, double burst) : per_second_(per_second), burst_(burst), left_(burst) {}
  /// Whether one more may come now.
  bool take(Time now);

 private:
  double per_second_, burst_, left_;
  std::optional<Time> last_;
};

/// A page that is connected: a WebSocket. Everything happens on the thread of its io_context.
///
/// Text is sent in order and never left out; a page that does not take it is dropped when too much waits.
/// Of pictures at most two are unanswered, and the next one is always the newest.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  /// `token` lives as long as the connection.
  Viewer(boost::beast::tcp_stream stream, SharedView& view, std::shared_ptr<void> token);

  /// Answers the request to become a WebSocket; then the view knows of this viewer until it is gone.
  void accept(const Request& request);

  /// No other page has or had it.
  std::uint64_t page_number() const { return page_number_; }

  void send(std::shared_ptr<const std::string> text);
  /// As send(), but only while nothing waits: the next one of its kind says it all again.
  void send_if_idle(std::shared_ptr<const std::string> text);
  void offer(const FrameMessage& frame);
  /// The page has drawn this frame, and so all before.
  void shown(std::uint64_t frame);
  /// Ends the connection as soon as what is being written is.
  void close(boost::beast::websocket::close_code code);

 private:
  void read();
  void take_message();
  void write();
  void written(boost::system::error_code failed);
  void leave();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  SharedView& view_;
  const std::uint64_t page_number_;
  const std::shared_ptr<void> token_;
  boost::beast::flat_buffer read_;
  RateLimit rate_;
  std::deque<std::shared_ptr<const std::string>> texts_;
  std::size_t text_bytes_ = 0;
  std::shared_ptr<const std::string> writing_;  ///< null: nothing is
  std::optional<FrameMessage> newest_;          ///< not sent yet
  std::deque<std::uint64_t> unanswered_;        ///< numbers of frames
  std::optional<boost::beast::websocket::close_code> closing_;
  bool joined_ = false, closed_ = false;
};

}  // namespace voxlume::server
