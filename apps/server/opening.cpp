#include "server/opening.h"

#include <boost/asio/post.hpp>
#include <filesystem>
#include <new>

#include "base/fail.h"
#include "base/parallel.h"
#include "scene/open_volume.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace asio = boost::asio;

std::string file_name(const std::string& path) {
  const std::filesystem::path p(path);
  return (p.has_filename() ? p : p.parent_path()).filename().string();
}

Opening::Opening(asio::io_context& io, LiveOptions options, OpeningListener listener)
    : io_(io), options_(options), listener_(std::move(listener)) {}

Opening::~Opening() {
  cancel();
  thread_.join();
}

void Opening::open(const SceneDescription& scene) {
  const std::uint64_t number = ++newest_;
  outdated_ = true;
  listener_.status({"reading", file_name(scene.volume.path), "", {}});
  asio::post(thread_, [this, scene, number] { read(scene, number); });
}

void Opening::cancel() {
  ++newest_;
  outdated_ = true;
}

void Opening::retire(std::shared_ptr<OpenedVolume> volume) {
  asio::post(thread_, [volume = std::move(volume)]() mutable { volume.reset(); });
}

void Opening::tell(std::uint64_t number, std::function<void()> work) {
  asio::post(io_, [this, number, work = std::move(work)] {
    if (number == newest_) work();
  });
}

void Opening::tell_status(std::uint64_t number, OpeningStatus status) {
  tell(number, [this, status = std::move(status)] { listener_.status(status); });
}

void Opening::read(const SceneDescription& scene, std::uint64_t number) {
  const std::string name = file_name(scene.volume.path);
  const auto failed = [&](const std::string& message) { tell_status(number, {"failed", name, message, {}}); };
  const auto progress = [&](const char* stage) {
    return [this, number, stage, name](double share) {
      if (outdated_) throw Cancelled();  // in the midst of what parallel_for hands out whole
      tell_status(number, {stage, name, "", share});
    };
  };
  try {
    outdated_ = false;
    if (number != newest_) return;
    const CancelScope scope(outdated_);
    Volume volume = open_volume(scene.volume, progress("reading"));
    tell_status(number, {"preparing", name, "", {}});
    auto opened = std::make_shared<OpenedVolume>();
    opened->name = name;
    opened->numbering = std::make_shared<FrameNumbering>();
    LiveListener listener = session_listener(number, opened->numbering);
    listener.preparing = progress("preparing");
    opened->session = std::make_unique<LiveSession>(scene, std::move(volume), std::move(listener), options_);
    opened->sides = std::make_unique<SideVolumes>(opened->session->session().volume());
    const Session& session = opened->session->session();
    opened->joint = std::make_unique<JointHistograms>(session.volume(), session.statistics());
    tell(number, [this, number, opened] {
      shown_ = number;
      listener_.opened(opened);
    });
  } catch (const Cancelled&) {
  } catch (const std::bad_alloc&) {
    failed("there is not enough memory; close other programs, or open a smaller volume");
  } catch (const std::exception& error) {
    failed(one_line(error.what()));
  }
}

LiveListener Opening::session_listener(std::uint64_t number, std::shared_ptr<FrameNumbering> numbering) {
  // The session's thread calls these; only what is posted touches this object.
  const auto to_io = [this, number](auto work) {
    asio::post(io_, [this, number, work = std::move(work)] {
      if (number == shown_) work();
    });
  };
  LiveListener out;
  out.frame = [this, to_io, numbering,
               coder = std::make_shared<FrameCoder>()](std::shared_ptr<const LiveFrame> frame) {
    try {
      to_io([this, message = coder->code(std::move(frame), *numbering)] { listener_.frame(message); });
    } catch (const std::exception& error) {
      to_io([this, message = std::string(error.what())] { listener_.trouble(message); });
    }
  };
  out.trouble = [this, to_io](std::uint64_t, const std::string& message) {
    to_io([this, message] { listener_.trouble(message); });
  };
  out.progress = [this, to_io](const RenderProgress& progress) {
    to_io([this, progress] { listener_.progress(progress); });
  };
  out.warnings = [this, to_io](const std::vector<std::string>& lines) {
    to_io([this, lines] { listener_.warnings(lines); });
  };
  out.compiling = [this, to_io](double share) { to_io([this, share] { listener_.compiling(share); }); };
  return out;
}

}  // namespace voxlume::server
