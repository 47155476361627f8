#include "server/viewer.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket.hpp>

#include "server/shared_view.h"

namespace voxlume::server {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

namespace {

constexpr std::size_t kMostMessageBytes = std::size_t{1} << 20;
constexpr double kMessagesPerSecond = 200, kBurst = 400;
constexpr std::size_t kMostUnanswered = 2;
/// A scene may be large; what waits beyond this belongs to a page that does not read.
constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20;
constexpr std::size_t kMostWaitingTexts = 5000;

}  // namespace

bool RateLimit::take(Time now) {
  if (last_)
    left_ = std::min(burst_, left_ + per_second_ * std::chrono::duration<double>(now - *last_).count());
  last_ = now;
  if (left_ < 1) return false;
  left_ -= 1;
  return true;
}

Viewer::Viewer(beast::tcp_stream stream, SharedView& view, std::shared_ptr<void> token)
    : socket_(std::move(stream)),
      view_(view),
      page_number_(view.next_page_number()),
      token_(std::move(token)),
      rate_(kMessagesPerSecond, kBurst) {}

void Viewer::accept(const Request& request) {
  auto& stream = beast::get_lowest_layer(socket_);
  stream.expires_never();
  error_code ignored;
  stream.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  socket_.set_option(
      websocket::stream_base::timeout{std::chrono::seconds(20), std::chrono::seconds(60), true});
  socket_.read_message_max(kMostMessageBytes);
  socket_.auto_fragment(false);
  socket_.async_accept(request, [self = shared_from_this()](error_code failed) {
    if (failed) return;
    self->joined_ = true;
    self->view_.join(self);
    self->read();
  });
}

void Viewer::read() {
  socket_.async_read(read_, [self = shared_from_this()](error_code failed, std::size_t) {
    if (failed) return self->leave();
    self->take_message();
  });
}

void Viewer::take_message() {
  if (closing_ || closed_) return;
  if (!rate_.take(std::chrono::steady_clock::now())) return close(websocket::close_code::policy_error);
  if (!socket_.got_text()) return close(websocket::close_code::unknown_data);
  const std::string text = beast::buffers_to_string(read_.data());
  read_.consume(read_.size());
  view_.receive(*this, text);
  if (!closing_ && !closed_) read();
}

void Viewer::send(std::shared_ptr<const std::string> text) {
  if (closing_ || closed_) return;
  text_bytes_ += text->size();
  texts_.push_back(std::move(text));
  if ((text_bytes_ > kMostWaitingBytes && texts_.size() > 1) || texts_.size() > kMostWaitingTexts) {
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    return leave();
  }
  write();
}

void Viewer::send_if_idle(std::shared_ptr<const std::string> text) {
  if (texts_.empty()) send(std::move(text));
}

void Viewer::offer(const FrameMessage& frame) {
  if (closing_ || closed_) return;
  newest_ = frame;
  write();
}

void Viewer::shown(std::uint64_t frame) {
  while (!unanswered_.empty() && unanswered_.front() <= frame) unanswered_.pop_front();
  write();
}

void Viewer::write() {
  if (writing_ || closed_) return;
  if (closing_) {
    closed_ = true;
    return socket_.async_close(*closing_, [self = shared_from_this()](error_code) { self->leave(); });
  }
  if (!texts_.empty()) {
    writing_ = std::move(texts_.front());
    texts_.pop_front();
    text_bytes_ -= writing_->size();
    socket_.text(true);
  } else if (newest_ && unanswered_.size() < kMostUnanswered) {
    writing_ = newest_->bytes;
    unanswered_.push_back(newest_->number);
    newest_.reset();
    socket_.binary(true);
  } else {
    return;
  }
  socket_.async_write(boost::asio::buffer(*writing_),
                      [self = shared_from_this()](error_code failed, std::size_t) { self->written(failed); });
}

void Viewer::written(error_code failed) {
  writing_.reset();
  if (failed) return leave();
  write();
}

void Viewer::close(websocket::close_code code) {
  if (closing_ || closed_) return;
  closing_ = code;
  texts_.clear();
  newest_.reset();
  leave();
  write();
}

void Viewer::leave() {
  if (!closing_) closed_ = true;
  if (!joined_) return;
  joined_ = false;
  view_.leave(*this);
}

}  // namespace voxlume::server
