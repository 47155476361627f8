#pragma once
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/live_session.h"
#include "server/frame_message.h"
#include "server/joint_histograms.h"
#include "server/side_volumes.h"

namespace voxlume::server {

/// A volume on screen, and what numbers its frames have.
struct OpenedVolume {
  std::string name;  ///< of its file or folder
  std::unique_ptr<LiveSession> session;
  std::unique_ptr<SideVolumes> sides;         ///< what its scenes have beside it
  std::unique_ptr<JointHistograms> joint;     ///< of it and those
  std::shared_ptr<FrameNumbering> numbering;  ///< set before the first frame is asked for
};

/// How far an open is.
struct OpeningStatus {
  std::string stage;            ///< "reading", "preparing", or "failed"
  std::string name;             ///< of the volume's file or folder
  std::string message;          ///< what to do when it failed
  std::optional<double> share;  ///< of the stage, where it is known
};

/// Whom Opening tells. All are called on the thread of its io_context, and of the newest open alone.
struct OpeningListener {
  std::function<void(const OpeningStatus&)> status;
  std::function<void(std::shared_ptr<OpenedVolume>)> opened;
  // Of the session that was opened last.
  std::function<void(const FrameMessage&)> frame;
  std::function<void(const std::string& message)> trouble;
  std::function<void(const RenderProgress&)> progress;
  std::function<void(const std::vector<std::string>&)> warnings;
  Progress compiling;  ///< as of LiveListener
};

/// Reads volumes and prepares them on a thread of its own, only the newest that was asked for: what it is at
/// when another comes ends within a second or two.
class Opening {
 public:
  Opening(boost::asio::io_context& io, LiveOptions options, OpeningListener listener);
  /// Ends what is being read.
  ~Opening();

  /// `scene` names its volume by a path that may be read, and need not be resolved.
  void open(const SceneDescription& scene);
  /// Ends what is being read or prepared, of which nothing is told any more.
  void cancel();
  /// Ends a session on the thread that reads, since that takes a moment.
  void retire(std::shared_ptr<OpenedVolume> volume);

 private:
  void read(const SceneDescription& scene, std::uint64_t number);
  void tell_status(std::uint64_t number, OpeningStatus status);
  LiveListener session_listener(std::uint64_t number, std::shared_ptr<FrameNumbering> numbering);
  /// Calls `work` on the io_context's thread unless another open came since.
  void tell(std::uint64_t number, std::function<void()> work);

  boost::asio::io_context& io_;
  const LiveOptions options_;
  const OpeningListener listener_;
  std::atomic<std::uint64_t> newest_{0};  ///< of the opens asked for
  std::atomic<bool> outdated_{false};     ///< what is read is not the newest
  std::uint64_t shown_ = 0;               ///< of the session opened last; of the io_context's thread
  boost::asio::thread_pool thread_{1};
};

/// "head.nrrd" of a path; of one that ends in a slash its folder.
std::string file_name(const std::string& path);

}  // namespace voxlume::server
