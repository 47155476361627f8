#pragma once
#include <boost/asio/io_context.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "server/opening.h"
#include "voxlume/scene.h"

namespace voxlume::server {

/// Small pictures of the open volume with every preset, drawn when they are first asked for.
class Thumbnails {
 public:
  /// `drawn` hears of every one that is there from now on, on the io_context's thread.
  Thumbnails(boost::asio::io_context& io, std::function<void(const std::string& preset)> drawn)
      : io_(io), told_(std::move(drawn)) {}

  /// Draws what is neither drawn nor being drawn, in the view and light of `scene`. Returns the presets whose
  /// pictures are there.
  std::vector<std::string> draw_all(OpenedVolume& volume, const SceneDescription& scene);
  /// PNG of preset `name`; null while it is not drawn.
  std::shared_ptr<const std::string> find(const std::string& name) const;
  /// Another volume is open.
  void forget();

 private:
  struct Drawn {
    std::map<std::string, std::shared_ptr<const std::string>> pictures;  ///< null: being drawn
  };

  boost::asio::io_context& io_;
  const std::function<void(const std::string&)> told_;
  std::shared_ptr<Drawn> drawn_ = std::make_shared<Drawn>();  ///< of this volume; of the io_context's thread
};

}  // namespace voxlume::server
