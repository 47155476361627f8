#include "test_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>
#include <stdexcept>

namespace voxlume::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

Address::Address(const std::string& url) {
  const std::size_t colon = url.rfind(':');
  port = static_cast<unsigned short>(std::stoi(url.substr(colon + 1)));
  token = url.substr(url.find("token=") + 6);
}

std::string Answer::header(const std::string& name) const {
  const std::size_t at = headers.find("\r\n" + name + ": ");
  if (at == std::string::npos) return "";
  const std::size_t start = at + name.size() + 4;
  return headers.substr(start, headers.find("\r\n", start) - start);
}

std::string talk(unsigned short port, const std::string& bytes, double patience_s) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    ::close(socket);
    throw std::runtime_error("cannot connect");
  }
  std::size_t sent = 0;
  std::string answer;
  for (bool open = true; open;) {
    pollfd wait{socket, static_cast<short>(POLLIN | (sent < bytes.size() ? POLLOUT : 0)), 0};
    if (::poll(&wait, 1, static_cast<int>(patience_s * 1000)) <= 0) break;
    if (wait.revents & POLLOUT) {
      const ssize_t n = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n > 0) sent += static_cast<std::size_t>(n);
      if (n < 0) sent = bytes.size();  // refused; the answer may be there already
    }
    if (wait.revents & (POLLIN | POLLHUP | POLLERR)) {
      char block[65536];
      const ssize_t n = ::recv(socket, block, sizeof block, MSG_DONTWAIT);
      if (n > 0) answer.append(block, static_cast<std::size_t>(n));
      open = n > 0;
    }
  }
  ::close(socket);
  return answer;
}

Answer parse_answer(const std::string& text) {
  Answer out;
  const std::size_t end = text.find("\r\n\r\n");
  if (!text.starts_with("HTTP/1.1 ") || end == std::string::npos) return out;
  out.status = std::stoi(text.substr(9, 3));
  out.headers = text.substr(0, end + 2);
  out.body = text.substr(end + 4);
  return out;
}

Answer ask(const Address& server, const Request& request) {
  std::string text = request.method + " " + request.path + " HTTP/1.1\r\nConnection: close\r\n";
  text += "Host: " + request.host.value_or(server.host()) + "\r\n";
  const std::string cookie = request.cookie.value_or(server.cookie());
  if (!cookie.empty()) text += "Cookie: " + cookie + "\r\n";
  for (const auto& [name, value] : request.headers) text += name + ": " + value + "\r\n";
  if (!request.body.empty() || request.method == "PUT")
    text += "Content-Length: " + std::to_string(request.body.size()) + "\r\n";
  return parse_answer(talk(server.port, text + "\r\n" + request.body));
}

json edit(int seq, const std::vector<std::pair<std::string, json>>& fields, const std::string& gesture) {
  json set = json::array();
  for (const auto& [pointer, value] : fields) set.push_back(json::array({pointer, value}));
  json message{{"type", "edit"}, {"seq", seq}, {"set", set}};
  if (!gesture.empty()) message["gesture"] = gesture;
  return message;
}

Page::Page(const Address& server, Manners manners) : socket_(io_), manners_(std::move(manners)) {
  socket_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    const std::string cookie = manners_.cookie.value_or(server.cookie());
    if (!cookie.empty()) request.set("Cookie", cookie);
    if (manners_.origin) request.set("Origin", *manners_.origin);
  }));
  socket_.read_message_max(std::size_t{64} << 20);
  auto& stream = beast::get_lowest_layer(socket_);
  stream.expires_never();
  stream.connect({asio::ip::address_v4::loopback(), server.port});
  boost::system::error_code result = asio::error::would_block;
  socket_.async_handshake(manners_.host.value_or(server.host()), "/api/socket",
                          [&](boost::system::error_code failed) { result = failed; });
  run("the handshake");
  if (result) throw std::runtime_error("the handshake was declined: " + result.message());
}

Page::~Page() { cut(); }

void Page::cut() {
  boost::system::error_code ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
}

void Page::run(const char* what, double patience_s) {
  io_.restart();
  io_.run_for(std::chrono::milliseconds(static_cast<int>(patience_s * 1000)));
  if (!io_.stopped()) throw std::runtime_error(std::string("waited in vain for ") + what);
}

void Page::send_text(const std::string& text, bool binary) {
  socket_.binary(binary);
  boost::system::error_code failed;
  socket_.write(asio::buffer(text), failed);
}

json Page::next() {
  boost::system::error_code result = asio::error::would_block;
  socket_.async_read(buffer_, [&](boost::system::error_code failed, std::size_t) { result = failed; });
  run("a message");
  if (result) throw std::runtime_error("the connection ended: " + result.message());
  const std::string bytes = beast::buffers_to_string(buffer_.data());
  buffer_.clear();
  if (socket_.got_text()) return json::parse(bytes);
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data(), 4);
  json header = json::parse(bytes.substr(4, size));
  last_picture_ = bytes.substr(4 + size);
  header["type"] = "frame";
  if (manners_.answers_frames) send({{"type", "shown"}, {"frame", header["frame"]}});
  return header;
}

json Page::next(const std::string& type) {
  return next(type, [](const json&) { return true; });
}

json Page::next(const std::string& type, const std::function<bool(const json&)>& wanted) {
  for (;;) {
    json message = next();
    if (message["type"] == type && wanted(message)) return message;
  }
}

int Page::read_to_close() {
  boost::system::error_code result;
  while (!result) {
    buffer_.clear();
    result = asio::error::would_block;
    socket_.async_read(buffer_, [&](boost::system::error_code failed, std::size_t) { result = failed; });
    run("the end");
  }
  return result == websocket::error::closed ? socket_.reason().code : 0;
}

bool Page::quiet_for(double seconds) {
  bool came = false;
  socket_.async_read(buffer_, [&](boost::system::error_code failed, std::size_t) { came = !failed; });
  io_.restart();
  io_.run_for(std::chrono::milliseconds(static_cast<int>(seconds * 1000)));
  const bool quiet = !came;
  if (!io_.stopped()) cut();  // a read cannot be taken back; this page is done
  io_.restart();
  io_.run();
  return quiet;
}

}  // namespace voxlume::test
