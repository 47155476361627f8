#pragma once
#include <cstddef>
#include <memory>

namespace voxlume {

/// The part of Open Image Denoise's C interface that is used, of version 1 or 2, found at run time: the
/// library is no part of the build. Names and values are those of its reference.
class OidnLibrary {
 public:
  using Device = void*;
  using Filter = void*;

  /// The file that the environment variable VOXLUME_OIDN_LIBRARY names, or else what the system has.
  /// Throws Error kUnsupported where there is none or it is something else.
  OidnLibrary();

  /// On the processor, with `threads` >= 1. Throws Error kUnsupported.
  std::shared_ptr<void> make_device(int threads) const;
  /// The general filter for path-traced pictures. Keeps the device.
  std::shared_ptr<void> make_filter(const std::shared_ptr<void>& device) const;

  /// `name`: color, albedo, normal or output. Three floats a pixel, without gaps, which must live as long as
  /// the filter.
  void set_image(Filter filter, const char* name, float* pixels, int width, int height) const;
  void set_flag(Filter filter, const char* name, bool value) const { set_filter_flag_(filter, name, value); }
  void commit(Filter filter) const { commit_filter_(filter); }
  /// Runs the filter. Throws Error kInternal with what the library says, of this or an earlier call.
  void execute(Device device, Filter filter) const;

 private:
  template <class Function>
  void find(Function& function, const char* name, const char* name_in_version_1 = nullptr);
  void throw_errors(Device device) const;

  std::shared_ptr<void> handle_;
  Device (*new_device_)(int type);
  void (*set_device_int_)(Device, const char* name, int value);
  void (*set_device_flag_)(Device, const char* name, bool value);
  void (*commit_device_)(Device);
  void (*release_device_)(Device);
  int (*device_error_)(Device, const char** message);
  Filter (*new_filter_)(Device, const char* type);
  void (*set_image_)(Filter, const char* name, void* pixels, int format, std::size_t width,
                     std::size_t height, std::size_t offset, std::size_t pixel_stride,
                     std::size_t row_stride);
  void (*set_filter_flag_)(Filter, const char* name, bool value);
  void (*commit_filter_)(Filter);
  void (*execute_filter_)(Filter);
  void (*release_filter_)(Filter);
};

}  // namespace voxlume
