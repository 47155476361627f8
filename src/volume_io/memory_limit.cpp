#include "volume_io/memory_limit.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <string>

#include "base/fail.h"
#include "base/memory.h"

namespace voxlume {
namespace {

std::string size_text(std::uint64_t bytes) {
  if (bytes < 10'000'000) return fmt::format("{} bytes", bytes);
  return bytes < 1'000'000'000 ? fmt::format("{:.0f} MB", static_cast<double>(bytes) * 1e-6)
                               : fmt::format("{:.1f} GB", static_cast<double>(bytes) * 1e-9);
}

}  // namespace

void check_memory(const std::filesystem::path& path, const Volume& volume, std::uint64_t bytes,
                  std::uint64_t limit_bytes) {
  const std::uint64_t limit = limit_bytes > 0 ? limit_bytes : available_memory_bytes();
  if (bytes <= limit) return;
  fail(ErrorCode::kOutOfMemory, path,
       fmt::format("{} {} voxels need {} of memory; {} {}", fmt::join(volume.size, "x"),
                   voxel_type_name(volume.type), size_text(bytes), size_text(limit),
                   limit_bytes > 0 ? "is the limit given" : "are available"));
}

std::shared_ptr<void> allocate_voxels(const std::filesystem::path& path, std::uint64_t bytes) {
  const std::size_t length = bytes;
  void* start = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (start == MAP_FAILED)
    fail(ErrorCode::kOutOfMemory, path, fmt::format("cannot allocate {} bytes", length));
  return {start, [length](void* p) { munmap(p, length); }};
}

}  // namespace voxlume
