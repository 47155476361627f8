#pragma once
#include <cstdint>

namespace voxlume {

/// Bytes this process may still take: the least of what the machine and its control group have left.
std::uint64_t available_memory_bytes();

/// From here on blocks of 4 MiB and more go back to the system as soon as they are freed. Else the C library
/// keeps them once it has seen some freed: of pictures that change their size as much again as is in use.
void give_back_large_blocks();

}  // namespace voxlume
