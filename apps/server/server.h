#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
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

/// Serves the viewer until SIGINT or SIGTERM. `started` gets the address to open once it can be opened. A
/// second signal ends the process. Throws Error kBadParameter where the address cannot be listened at.
void serve(const ServerOptions& options, const std::function<void(const std::string& url)>& started);

}  // namespace voxlume::server
