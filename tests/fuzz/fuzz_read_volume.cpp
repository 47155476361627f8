// libFuzzer target of the volume readers. The first byte of an input chooses the extension, the rest is the
// file. Reading happens in this process, not in the usual child, so that a crash of a reader is a crash of
// the fuzzer. GDCM, HDF5 and OpenVDB, which alone parse their formats, stop on damaged files by failed
// assertions; that is what the child is for, and tests/volume_io/damage_test.cpp tests. Here are the formats
// that our own code parses.
#include <stdlib.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "volume_io/isolated_read.h"
#include "voxlume/error.h"

namespace {

constexpr const char* kExtensions[] = {".nrrd", ".nhdr", ".mha", ".mhd", ".nii", ".nii.gz", ".vtk", ".tif"};

const std::filesystem::path& folder() {
  static const std::filesystem::path path = [] {
    std::string name = (std::filesystem::temp_directory_path() / "voxlume-fuzz-XXXXXX").string();
    if (!mkdtemp(name.data())) std::abort();
    return std::filesystem::path(name);
  }();
  return path;
}

/// Reads every byte, so that a sanitizer sees a volume shorter than it says.
std::uint64_t sum_of(const voxlume::Volume& volume) {
  std::uint64_t sum = 0;
  const auto* bytes = static_cast<const unsigned char*>(volume.voxels.get());
  for (std::size_t i = 0; i < volume.byte_count(); ++i) sum += bytes[i];
  return sum;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::filesystem::path path =
      folder() / (std::string("input") + kExtensions[data[0] % std::size(kExtensions)]);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  voxlume::ReadOptions options;
  options.memory_limit_bytes = 64u << 20;
  try {
    volatile std::uint64_t sum = sum_of(voxlume::read_in_process(path, options));
    static_cast<void>(sum);
  } catch (const voxlume::Error& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
  }
  return 0;
}
