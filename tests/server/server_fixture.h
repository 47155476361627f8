#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "server/server.h"
#include "support/temporary_folder.h"
#include "support/volumes.h"
#include "test_client.h"
#include "voxlume/volume_io.h"

namespace voxlume::test {

/// Value of the voxel (i, j, k) of ramp.nrrd.
inline double ramp(std::int64_t i, std::int64_t j, std::int64_t k) {
  return static_cast<double>(i + 20 * j + 400 * k);
}
constexpr std::int64_t kRampEdge = 16;

/// A server of this process, whose folder has ramp.nrrd (ramp() on 16^3 voxels of 1 mm, centred), labels.nrrd
/// on the same grid (1 where x < 0, else 2) with names, and a page.
class ServerTest : public testing::Test {
 protected:
  void SetUp() override {
    const double first = -0.5 * (kRampEdge - 1);
    const Placement centred{.origin_mm = {first, first, first}};
    const Size3 size{kRampEdge, kRampEdge, kRampEdge};
    std::filesystem::create_directories(files_ / "inside");
    std::filesystem::create_directories(page_ / "assets");
    write_volume(make_volume<std::int16_t>(size, ramp, centred), files_ / "ramp.nrrd");
    write_volume(make_volume<std::uint8_t>(
                     size, [](auto i, auto, auto) { return i < kRampEdge / 2 ? 1 : 2; }, centred),
                 files_ / "labels.nrrd");
    write_bytes(files_ / "labels.txt", "1 left 255 0 0\n2 right 0 255 0\n");
    write_bytes(folder_ / "secret.nrrd", "outside");
    write_bytes(page_ / "index.html", "<!doctype html>the page");
    write_bytes(page_ / "assets/app.js", "let x");
  }
  void TearDown() override { stop(); }

  server::ServerOptions options() const {
    server::ServerOptions out;
    out.folder = files_;
    out.page = page_;
    out.program = VOXLUME_BINARY;
    out.live.rest_s = 0.05;
    return out;
  }
  /// A scene of ramp.nrrd whose picture takes no time.
  SceneDescription ramp_scene() const {
    SceneDescription scene;
    scene.volume.path = (files_ / "ramp.nrrd").string();
    scene.transfer.points = {{.value = 0, .opacity = 0.9, .mu_t_per_mm = {}, .color = {}, .emission = {}},
                             {.value = 7000, .opacity = 0.9, .mu_t_per_mm = {}, .color = {}, .emission = {}}};
    scene.image.width = 32;
    scene.image.height = 24;
    scene.image.spp = 2;
    return scene;
  }
  const Address& start(const server::ServerOptions& options) {
    server_ = std::make_unique<server::Server>(options);
    thread_ = std::thread([this] { server_->run(); });
    address_.emplace(server_->url());
    return *address_;
  }
  const Address& start() { return start(options()); }
  /// Returns when it is open.
  const Address& start_with_ramp() {
    server::ServerOptions out = options();
    out.scene = ramp_scene();
    start(out);
    Page(*address_).next("scene");
    return *address_;
  }
  void stop() {
    if (!server_) return;
    server_->stop();
    thread_.join();
    server_.reset();
  }

  TemporaryFolder folder_;
  const std::filesystem::path files_ = folder_ / "files", page_ = folder_ / "page";
  std::unique_ptr<server::Server> server_;
  std::optional<Address> address_;
  std::thread thread_;
};

}  // namespace voxlume::test
