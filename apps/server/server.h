#pragma once
#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "render/live_session.h"
#include "voxlume/scene.h"

namespace voxlume::server {

struct ServerOptions {
  std::string address = "127.0.0.1";      ///< to listen at
  unsigned short port = 0;                ///< 0: any that is free
  std::filesystem::path folder;           ///< whose files pages may open
  std::optional<SceneDescription> scene;  ///< opened at the start; its paths may be anywhere
  std::filesystem::path program;          ///< this program's file, which renders animations
  std::filesystem::path samples;          ///< a folder of sample data; may be empty
  std::filesystem::path page;             ///< the page's files; empty: none
  std::uint64_t most_upload_bytes = std::uint64_t{8} << 30;
  LiveOptions live;
};

/// The viewer's server. One thread runs it; the volume's session, the reader of volumes and some workers have
/// threads of their own.
class Server {
 public:
  /// Listens, and begins to open the scene. Throws Error: kBadParameter where the address cannot be listened
  /// at, kFileNotFound where there is no such folder.
  explicit Server(const ServerOptions& options);
  ~Server();

  /// The address to open, with its token.
  std::string url() const;
  /// Serves until stop(), SIGINT, SIGTERM or SIGHUP; a second signal ends the process. Call once.
  void run();
  /// Any thread.
  void stop();

 private:
  struct Parts;
  const std::unique_ptr<boost::asio::io_context> io_;
  const std::unique_ptr<Parts> parts_;
};

}  // namespace voxlume::server
