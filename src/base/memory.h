#pragma once
#include <cstdint>

namespace voxlume {

/// Bytes this process may still take: the least of what the machine and its control group have left.
std::uint64_t available_memory_bytes();

}  // namespace voxlume
