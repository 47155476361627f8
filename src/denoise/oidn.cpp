#include "denoise/oidn.h"

#include "base/parallel.h"
#include "denoise/oidn_library.h"
#include "denoise/signal.h"

namespace voxlume {
namespace {

using Pixels = std::vector<float>;  ///< three floats a pixel, row by row from the top

class Oidn final : public Denoiser {
 public:
  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override {
    prepare(frame.width, frame.height);
    out.resize(frame.width, frame.height);
    pack(frame);
    for (const std::shared_ptr<void>& filter : {albedo_filter_, normal_filter_, color_filter_})
      library_.execute(device_.get(), filter.get());
    filter_alpha(frame.alpha, frame.samples, out.alpha);
    unpack(out);
  }

  void forget() override {}

 private:
  /// Filters for pictures of this size and for as many threads as parallel_for has.
  void prepare(int width, int height) {
    const int threads = thread_count();
    if (width == width_ && height == height_ && threads == threads_) return;
    width_ = height_ = 0;  // until all is made
    if (threads != threads_) device_ = library_.make_device(threads);
    threads_ = threads;
    for (Pixels* pixels : {&color_, &albedo_, &normal_, &result_})
      pixels->assign(static_cast<std::size_t>(width) * height * 3, 0.0f);
    albedo_filter_ = make_filter({{"albedo", &albedo_}, {"output", &albedo_}}, width, height);
    normal_filter_ = make_filter({{"normal", &normal_}, {"output", &normal_}}, width, height);
    color_filter_ =
        make_filter({{"color", &color_}, {"albedo", &albedo_}, {"normal", &normal_}, {"output", &result_}},
                    width, height);
    width_ = width;
    height_ = height;
  }

  struct Image {
    const char* name;
    Pixels* pixels;
  };
  std::shared_ptr<void> make_filter(std::initializer_list<Image> images, int width, int height) const {
    std::shared_ptr<void> filter = library_.make_filter(device_);
    for (const Image& image : images)
      library_.set_image(filter.get(), image.name, image.pixels->data(), width, height);
    if (images.size() > 2) {
      library_.set_flag(filter.get(), "hdr", true);
      library_.set_flag(filter.get(), "cleanAux", true);
    }
    library_.commit(filter.get());
    return filter;
  }

  void pack(const DenoiseFrame& frame) {
    for_rows([&](int y) {
      std::size_t i = static_cast<std::size_t>(y) * width_ * 3;
      for (int x = 0; x < width_; ++x) {
        const float alpha = frame.alpha.at(x, y);
        for (int c = 0; c < 3; ++c, ++i) {
          color_[i] = std::max(0.0f, frame.radiance[c].at(x, y));
          albedo_[i] = std::clamp(alpha * frame.albedo[c].at(x, y), 0.0f, 1.0f);
          normal_[i] = alpha * frame.normal[c].at(x, y);
        }
      }
    });
  }

  /// Nothing where there is no matter: the network's colours may bleed a little.
  void unpack(DenoisedFrame& out) const {
    for_rows([&](int y) {
      std::size_t i = static_cast<std::size_t>(y) * width_ * 3;
      for (int x = 0; x < width_; ++x) {
        const bool matter = out.alpha.at(x, y) > 0;
        for (int c = 0; c < 3; ++c, ++i)
          out.radiance[c].at(x, y) = matter ? std::max(0.0f, result_[i]) : 0.0f;
      }
    });
  }

  template <class Body>
  void for_rows(const Body& body) const {
    parallel_for(height_, 8, [&](std::int64_t y) { body(static_cast<int>(y)); });
  }

  OidnLibrary library_;
  std::shared_ptr<void> device_, albedo_filter_, normal_filter_, color_filter_;
  Pixels color_, albedo_, normal_, result_;
  int width_ = 0, height_ = 0, threads_ = 0;
};

}  // namespace

std::unique_ptr<Denoiser> make_oidn() { return std::make_unique<Oidn>(); }

}  // namespace voxlume
