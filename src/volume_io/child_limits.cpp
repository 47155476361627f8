#include "volume_io/child_limits.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fstream>

#include "base/memory.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VOXLUME_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define VOXLUME_SANITIZED 1
#endif
#endif

#ifdef VOXLUME_SANITIZED
#include <atomic>

// From sanitizer/allocator_interface.h and common_interface_defs.h, which not every compiler package has.
extern "C" {
int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                              void (*)(const volatile void*));
std::size_t __sanitizer_get_allocated_size(const volatile void*);
void __sanitizer_set_report_fd(void*);
__attribute__((weak)) void __asan_set_error_report_callback(void (*)(const char*));
}
#endif

namespace voxlume {
namespace {

constexpr std::uint64_t kSlackBytes = 512ull << 20;

/// The bytes of a file, or of the files of a folder.
std::uint64_t input_bytes(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    const std::uint64_t bytes = std::filesystem::file_size(path, error);
    return error ? 0 : bytes;
  }
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
    const std::uint64_t one = entry.is_regular_file(error) ? entry.file_size(error) : 0;
    bytes += error ? 0 : one;
  }
  return bytes;
}

void limit(int resource, std::uint64_t value) {
  rlimit limits{};
  getrlimit(static_cast<__rlimit_resource_t>(resource), &limits);
  limits.rlim_cur = std::min<rlim_t>(value, limits.rlim_max);
  setrlimit(static_cast<__rlimit_resource_t>(resource), &limits);
}

std::uint64_t cpu_limit_seconds(std::uint64_t bytes) {
  constexpr std::uint64_t kBase = 20;
  constexpr std::uint64_t kBytesPerSecond = 1 << 20;  // far slower than any decoder
  return kBase + bytes / kBytesPerSecond;
}

#ifdef VOXLUME_SANITIZED

// Sanitizers reserve terabytes of address space, so the limit is put on what is allocated instead.
std::atomic<std::uint64_t> allocated_bytes{0};
std::atomic<std::uint64_t> allowed_bytes{0};

void count_allocation(const volatile void*, std::size_t bytes) {
  if (allocated_bytes.fetch_add(bytes) + bytes > allowed_bytes.load()) _exit(kChildOutOfMemory);
}

void count_release(const volatile void* start) {
  const std::size_t bytes = __sanitizer_get_allocated_size(start);
  std::uint64_t now = allocated_bytes.load();
  while (!allocated_bytes.compare_exchange_weak(now, now - std::min<std::uint64_t>(now, bytes))) {
  }
}

void start_memory_limit(std::uint64_t bytes) {
  allowed_bytes = bytes;
  __sanitizer_install_malloc_and_free_hooks(count_allocation, count_release);
}

void raise_memory_limit(std::uint64_t, std::uint64_t working_bytes) {
  allowed_bytes += working_bytes + kSlackBytes;
}

/// A size that only a damaged file asks for is no defect of the reader.
void tell_absurd_size(const char* report) {
  for (const char* kind : {"allocation-size-too-big", "out-of-memory", "allocator is out of memory"}) {
    if (std::strstr(report, kind)) _exit(kChildOutOfMemory);
  }
}

void keep_sanitizer_reports() {
  if (__asan_set_error_report_callback) __asan_set_error_report_callback(tell_absurd_size);
  __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(dup(STDERR_FILENO))));
}

#else

std::uint64_t address_space_bytes() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void start_memory_limit(std::uint64_t bytes) { limit(RLIMIT_AS, address_space_bytes() + bytes); }

void raise_memory_limit(std::uint64_t voxel_bytes, std::uint64_t working_bytes) {
  limit(RLIMIT_AS, address_space_bytes() + voxel_bytes + working_bytes + kSlackBytes);
}

void keep_sanitizer_reports() {}

#endif

}  // namespace

bool has_sanitizer() {
#ifdef VOXLUME_SANITIZED
  return true;
#else
  return false;
#endif
}

void enter_child_limits(const std::filesystem::path& path) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent decides what an interrupt means, and may want the volume all the same.
  signal(SIGINT, SIG_IGN);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGTERM}) {
#ifdef VOXLUME_SANITIZED
    if (number != SIGXCPU && number != SIGTERM) continue;  // the sanitizer reports these
#endif
    signal(number, SIG_DFL);
  }
  keep_sanitizer_reports();
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  const std::uint64_t bytes = input_bytes(path);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, cpu_limit_seconds(bytes));
  // A header may be a whole compressed tree (OpenVDB): some multiple of the file, never more than there is.
  constexpr std::uint64_t kHeaderBytesPerFileByte = 64;
  start_memory_limit(kSlackBytes + std::min(bytes * kHeaderBytesPerFileByte, available_memory_bytes()));
}

void allow_voxel_memory(std::uint64_t voxel_bytes, std::uint64_t working_bytes) {
  rlimit limits{};
  getrlimit(RLIMIT_CPU, &limits);
  limit(RLIMIT_CPU, limits.rlim_cur + cpu_limit_seconds(voxel_bytes + working_bytes));
  raise_memory_limit(voxel_bytes, working_bytes);
}

long wall_limit_seconds(const std::filesystem::path& path) {
  // Compressed data may grow a lot; a slow network disk reads a megabyte a second.
  return 600 + static_cast<long>(std::min<std::uint64_t>(input_bytes(path) / (1 << 18), 1'000'000));
}

}  // namespace voxlume
