#include "render/live_session.h"

#include <utility>

#include "render/live_loop.h"

namespace voxlume {

LiveSession::LiveSession(const SceneDescription& scene, Volume volume, LiveListener listener,
                         LiveOptions options)
    : session_(scene, std::move(volume), listener.preparing),
      listener_(std::move(listener)),
      options_(options) {
  thread_ = std::thread([this] { Loop(*this).run(); });
}

LiveSession::~LiveSession() {
  {
    const std::lock_guard lock(mutex_);
    wishes_.ending = true;
    cancel_ = ending_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

SceneDescription LiveSession::resolved(const SceneDescription& scene) const {
  return session_.resolved(scene);
}

std::uint64_t LiveSession::show(SceneDescription scene) {
  const std::lock_guard lock(mutex_);
  wishes_.scene = std::move(scene);
  cancel_ = true;
  wake_.notify_all();
  return ++wishes_.revision;
}

void LiveSession::set_split(std::optional<double> split) {
  const std::lock_guard lock(mutex_);
  wishes_.split = split;
  wishes_.split_changed = true;
  cancel_ = true;
  wake_.notify_all();
}

void LiveSession::set_watched(bool watched) {
  const std::lock_guard lock(mutex_);
  wishes_.watched = watched;
  if (!watched) cancel_ = true;
  wake_.notify_all();
}

void LiveSession::set_yielding(bool yielding) {
  const std::lock_guard lock(mutex_);
  wishes_.yielding = yielding;
  wake_.notify_all();
}

void LiveSession::draw_aside(SceneDescription scene, int spp, std::function<void(Image8)> done) {
  const std::lock_guard lock(mutex_);
  wishes_.asides.push_back({std::move(scene), spp, std::move(done)});
  wake_.notify_all();
}

}  // namespace voxlume
