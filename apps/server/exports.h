#pragma once
#include <sys/types.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "voxlume/scene.h"

namespace voxlume::server {

/// Renders animations to files, one at a time, by a process of this program of its own. What is finished
/// stays until the end.
class Exports {
 public:
  /// `told` gets the messages of docs/viewer-protocol.md.
  Exports(boost::asio::io_context& io, std::filesystem::path program, std::filesystem::path folder,
          std::function<void(const nlohmann::json&)> told);
  ~Exports() { end(); }

  /// Throws Error kBadParameter, kUnsupported: a name that is no .mp4, .webm or .zip, a scene that stands
  /// still, ffmpeg missing, another one under way.
  void start(SceneDescription scene, const std::string& file);
  /// Nothing where nothing is rendered.
  void cancel();
  /// Ends what is being rendered, for good.
  void end();

  /// A finished file; empty where there is none of that name.
  std::filesystem::path finished(const std::string& file) const;
  /// The newest message; null where there was none.
  const nlohmann::json& state() const { return state_; }

 private:
  struct Job {
    std::string file;
    std::filesystem::path folder, output, frames;  ///< of its own; what is written; where its frames lie
    int frame_count = 0;
    pid_t process = -1;
    bool cancelled = false;
  };

  void watch();
  void look();
  void ended(int status);
  void zip();
  void finish(const std::string& state, const std::string& message = "");
  void tell(const std::string& state, const std::string& message = "");

  boost::asio::io_context& io_;
  const std::filesystem::path program_, folder_;
  const std::function<void(const nlohmann::json&)> told_;
  boost::asio::steady_timer timer_;
  boost::asio::thread_pool zipping_{1};
  std::optional<Job> job_;
  std::map<std::string, std::filesystem::path> finished_;
  nlohmann::json state_;
  int count_ = 0;
};

}  // namespace voxlume::server
