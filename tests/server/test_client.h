#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace voxlume::test {

using nlohmann::json;

/// After so long whatever is waited for has failed.
constexpr double kPatience_s = 60;

/// Where a server listens, and what lets one in.
struct Address {
  explicit Address(const std::string& url);
  std::string host() const { return "127.0.0.1:" + std::to_string(port); }
  std::string cookie() const { return "voxlume_" + std::to_string(port) + "=" + token; }

  unsigned short port;
  std::string token;
};

/// An answer to a request; status 0: the connection was closed without one.
struct Answer {
  int status = 0;
  std::string headers, body;
  /// Empty where it is not there.
  std::string header(const std::string& name) const;
};

/// Sends bytes as they are and reads until the server closes or says nothing more for `patience_s`.
std::string talk(unsigned short port, const std::string& bytes, double patience_s = kPatience_s);
Answer parse_answer(const std::string& text);

/// A request as a browser with the cookie would send it, answered on a connection of its own.
struct Request {
  std::string method = "GET", path = "/", body{};
  std::vector<std::pair<std::string, std::string>> headers{};
  std::optional<std::string> host{}, cookie{};  ///< absent: the right ones
};
Answer ask(const Address& server, const Request& request);
inline Answer get(const Address& server, const std::string& path) { return ask(server, {.path = path}); }

/// An edit of several fields, or of one.
json edit(int seq, const std::vector<std::pair<std::string, json>>& fields, const std::string& gesture = "");
inline json edit(int seq, const std::string& pointer, const json& value, const std::string& gesture = "") {
  return edit(seq, {{pointer, value}}, gesture);
}

/// A page: a WebSocket. Every wait ends in an exception after kPatience_s.
class Page {
 public:
  struct Manners {
    bool answers_frames = true;  ///< says "shown"
    std::optional<std::string> host{}, cookie{}, origin{};
  };

  explicit Page(const Address& server) : Page(server, Manners{}) {}
  Page(const Address& server, Manners manners);
  ~Page();
  Page(const Page&) = delete;

  void send(const json& message) { send_text(message.dump()); }
  void send_text(const std::string& text, bool binary = false);
  /// The next text or picture; of a picture {"type": "frame", ...header}.
  json next();
  /// The next one of this type, others passed over.
  json next(const std::string& type);
  /// The next one that `wanted` says yes to.
  json next(const std::string& type, const std::function<bool(const json&)>& wanted);
  /// Reads until the server closes; the code, 0 where it just ended.
  int read_to_close();
  /// Whether anything came within this time.
  bool quiet_for(double seconds);
  const std::string& last_picture() const { return last_picture_; }
  void cut();

 private:
  void run(const char* what, double patience_s = kPatience_s);

  boost::asio::io_context io_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::beast::flat_buffer buffer_;
  Manners manners_;
  std::string last_picture_;
};

}  // namespace voxlume::test
