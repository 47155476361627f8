#include "volume_io/memory_limit.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "volume_io/fail.h"

namespace voxlume {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

std::uint64_t machine_available_bytes() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  std::uint64_t kilobytes = 0;
  std::string unit;
  while (file >> key >> kilobytes) {
    if (key == "MemAvailable:") return kilobytes * 1024;
    std::getline(file, unit);
  }
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t number_in(const char* path) {
  std::uint64_t number = 0;
  std::ifstream file(path);
  return file >> number ? number : kNoLimit;
}

std::uint64_t group_available_bytes() {
  const std::uint64_t most = number_in("/sys/fs/cgroup/memory.max");
  const std::uint64_t used = number_in("/sys/fs/cgroup/memory.current");
  if (most == kNoLimit || used == kNoLimit) return kNoLimit;
  return most - std::min(used, most);
}

std::string size_text(std::uint64_t bytes) {
  if (bytes < 10'000'000) return fmt::format("{} bytes", bytes);
  return bytes < 1'000'000'000 ? fmt::format("{:.0f} MB", static_cast<double>(bytes) * 1e-6)
                               : fmt::format("{:.1f} GB", static_cast<double>(bytes) * 1e-9);
}

}  // namespace

std::uint64_t available_memory_bytes() {
  return std::min(machine_available_bytes(), group_available_bytes());
}

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
