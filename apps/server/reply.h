#pragma once
#include <boost/beast/http/status.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace voxlume::server {

/// The answer to an HTTP request: text, or a file.
struct Reply {
  using Status = boost::beast::http::status;

  Status status = Status::ok;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body = std::make_shared<const std::string>();
  std::filesystem::path file;  ///< sent instead of `body` when not empty
  bool remove_file = false;    ///< once it is sent
  std::vector<std::pair<std::string, std::string>> headers;
};

/// Takes the reply, later perhaps, once.
using Respond = std::function<void(Reply)>;

/// One line of text.
inline Reply error_reply(Reply::Status status, const std::string& line) {
  Reply reply;
  reply.status = status;
  reply.body = std::make_shared<const std::string>(line + "\n");
  return reply;
}

inline Reply json_reply(std::string text) {
  Reply reply;
  reply.type = "application/json";
  reply.body = std::make_shared<const std::string>(std::move(text));
  return reply;
}

}  // namespace voxlume::server
