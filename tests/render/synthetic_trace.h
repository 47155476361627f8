#pragma once
#include <cmath>
#include <vector>

#include "film/film.h"
#include "render/render_loop.h"
#include "sampling/rng.h"

namespace voxlume::test {

constexpr FilmLayers kAllLayers{.depth = true, .normal = true, .albedo = true};

/// A sample that depends on pixel and sample alone. One in a thousand is not finite.
inline PixelSample synthetic_sample(int x, int y, int sample) {
  Rng rng(7, 0, static_cast<std::uint32_t>(y * 4096 + x), static_cast<std::uint32_t>(sample));
  PixelSample s;
  s.radiance = {rng.next(), 3 * rng.next(), rng.next() * rng.next()};
  s.alpha = rng.next() < 0.7f ? 1.0f : 0.0f;
  s.albedo = {rng.next(), rng.next(), rng.next()};
  s.normal = {rng.next(), rng.next(), rng.next()};
  s.depth_mm = 1000 * rng.next();
  if (rng.next() < 0.001f) s.radiance.y = std::nanf("");
  return s;
}

inline void synthetic_trace(const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      for (int s = begin; s < end; ++s) {
        film.add(x, y, synthetic_sample(x, y, s));
        counters += {.paths = 1,
                     .tracking_steps = static_cast<std::uint64_t>(x + s),
                     .shadow_rays = 2,
                     .scatterings = 3,
                     .majorant_violations = 0};
      }
    }
  }
}

/// Every accumulator of the film, to compare films bit for bit.
inline std::vector<std::byte> film_bytes(const Film& film) {
  std::vector<std::byte> bytes;
  for (const auto span : film.accumulators()) bytes.insert(bytes.end(), span.begin(), span.end());
  return bytes;
}

inline RenderState new_state(int width, int height, int tile_size) {
  return {.film = Film(width, height, kAllLayers), .counters = {}, .elapsed_s = 0, .tile_size = tile_size};
}

/// `spp` samples of every pixel, added without a loop, tiles or threads.
inline RenderState direct_state(int width, int height, int spp) {
  RenderState state = new_state(width, height, 32);
  synthetic_trace({0, 0, width, height}, 0, spp, state.film, state.counters);
  return state;
}

}  // namespace voxlume::test
