#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "render/render_loop.h"
#include "voxlume/renderer.h"

namespace voxlume {

/// Statistics with everything filled in that the state of a render knows; times of loading, threads, simd,
/// seed and version are the caller's.
RenderStatistics statistics_from(const RenderState& state);

/// The keys of `--stats`: the fields of RenderStatistics, bytes of lists as importance_list_mb, and the rates
/// steps_per_s and paths_per_s.
nlohmann::json to_json(const RenderStatistics& statistics);

/// Largest resident set so far of this process, or of its largest finished child if that was larger.
std::uint64_t peak_rss_bytes();

/// Writes to_json() to a file, aside and renamed. Throws Error kFileNotFound, kInternal.
void write_statistics(const RenderStatistics& statistics, const std::filesystem::path& path);

}  // namespace voxlume
