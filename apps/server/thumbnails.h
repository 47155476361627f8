#pragma once
#include <boost/asio/io_context.hpp>
#include <map>
#include <memory>
#include <string>

#include "server/opening.h"
#include "voxlume/scene.h"

namespace voxlume::server {

/// Small pictures of the open volume with every preset, drawn when they are first asked for.
class Thumbnails {
 public:
  explicit Thumbnails(boost::asio::io_context& io) : io_(io) {}

  /// PNG of preset `name` in the view and light of `scene`; null while it is not drawn. Throws Error
  /// kFileNotFound where there is no such preset.
  std::shared_ptr<const std::string> find(const std::string& name, OpenedVolume& volume,
                                          const SceneDescription& scene);
  /// Another volume is open.
  void forget();

 private:
  struct Drawn {
    std::map<std::string, std::shared_ptr<const std::string>> pictures;  ///< null: being drawn
  };

  boost::asio::io_context& io_;
  std::shared_ptr<Drawn> drawn_ = std::make_shared<Drawn>();  ///< of this volume; of the io_context's thread
};

}  // namespace voxlume::server
