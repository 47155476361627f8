#include "denoise/oidn_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr const char* kVariable = "VOXLUME_OIDN_LIBRARY";
constexpr const char* kSystemNames[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                        "libOpenImageDenoise.so"};
// Values of the library's enumerations.
constexpr int kCpuDevice = 1, kFloat3 = 3;

std::shared_ptr<void> open_library() {
  const auto open = [](const char* name) {
    void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    return std::shared_ptr<void>(handle, [](void* h) {
      if (h) dlclose(h);
    });
  };
  const char* chosen = std::getenv(kVariable);
  if (chosen && *chosen) {
    if (auto handle = open(chosen)) return handle;
    throw Error(ErrorCode::kUnsupported, kVariable,
                fmt::format("\"{}\" cannot be loaded: {}", chosen, dlerror()));
  }
  std::string names;
  for (const char* name : kSystemNames) {
    if (auto handle = open(name)) return handle;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  }
  throw Error(
      ErrorCode::kUnsupported, "",
      fmt::format("the denoiser oidn needs Open Image Denoise; looked for {}: install it, or set {} to the "
                  "library's path",
                  names, kVariable));
}

}  // namespace

template <class Function>
void OidnLibrary::find(Function& function, const char* name, const char* name_in_version_1) {
  void* symbol = dlsym(handle_.get(), name);
  if (!symbol && name_in_version_1) symbol = dlsym(handle_.get(), name_in_version_1);
  if (!symbol) {
    const char* chosen = std::getenv(kVariable);
    const bool by_user = chosen && *chosen;
    throw Error(ErrorCode::kUnsupported, by_user ? kVariable : "",
                fmt::format("no function {} in {}; expected Open Image Denoise, version 1 or 2", name,
                            by_user ? fmt::format("\"{}\"", chosen) : "the system's libOpenImageDenoise"));
  }
  function = reinterpret_cast<Function>(symbol);
}

OidnLibrary::OidnLibrary() : handle_(open_library()) {
  find(new_device_, "oidnNewDevice");
  find(set_device_int_, "oidnSetDeviceInt", "oidnSetDevice1i");
  find(set_device_flag_, "oidnSetDeviceBool", "oidnSetDevice1b");
  find(commit_device_, "oidnCommitDevice");
  find(release_device_, "oidnReleaseDevice");
  find(device_error_, "oidnGetDeviceError");
  find(new_filter_, "oidnNewFilter");
  find(set_image_, "oidnSetSharedFilterImage");
  find(set_filter_flag_, "oidnSetFilterBool", "oidnSetFilter1b");
  find(commit_filter_, "oidnCommitFilter");
  find(execute_filter_, "oidnExecuteFilter");
  find(release_filter_, "oidnReleaseFilter");
}

std::shared_ptr<void> OidnLibrary::make_device(int threads) const {
  const Device device = new_device_(kCpuDevice);
  if (!device) {
    const char* message = nullptr;
    device_error_(nullptr, &message);
    throw Error(
        ErrorCode::kUnsupported, "",
        fmt::format("Open Image Denoise has no device for this processor: {}", message ? message : ""));
  }
  set_device_int_(device, "numThreads", threads);
  // Its threads are not to be bound to processors: they share them with ours.
  set_device_flag_(device, "setAffinity", false);
  commit_device_(device);
  std::shared_ptr<void> owner(device,
                              [library = handle_, release = release_device_](void* d) { release(d); });
  throw_errors(device);
  return owner;
}

std::shared_ptr<void> OidnLibrary::make_filter(const std::shared_ptr<void>& device) const {
  const Filter filter = new_filter_(device.get(), "RT");
  if (!filter) throw_errors(device.get());
  return {filter, [device, release = release_filter_](void* f) {
            if (f) release(f);
          }};
}

void OidnLibrary::set_image(Filter filter, const char* name, float* pixels, int width, int height) const {
  set_image_(filter, name, pixels, kFloat3, static_cast<std::size_t>(width), static_cast<std::size_t>(height),
             0, 0, 0);
}

void OidnLibrary::execute(Device device, Filter filter) const {
  execute_filter_(filter);
  throw_errors(device);
}

void OidnLibrary::throw_errors(Device device) const {
  const char* message = nullptr;
  if (device_error_(device, &message) != 0)
    throw Error(ErrorCode::kInternal, "",
                fmt::format("Open Image Denoise: {}", message ? message : "unknown error"));
}

}  // namespace voxlume
