#include "render/film_image.h"

#include "render/frame_image.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr const char* kVariance = "variance";

// One row of the table in voxlume/image.h.
struct LayerKind {
  const char* name;
  std::vector<std::string> channels;
  FilmLayers needs;
  Vec3d (*value)(const Film&, int x, int y);  // as many components as channels
};

const std::vector<LayerKind>& layer_kinds() {
  static const std::vector<LayerKind> kinds = {
      {"alpha", {"Y"}, {}, [](const Film& film, int x, int y) { return Vec3d(film.alpha(x, y)); }},
      {"depth",
       {"Z"},
       {.depth = true},
       [](const Film& film, int x, int y) { return Vec3d(film.depth_mm(x, y)); }},
      {"normal",
       {"X", "Y", "Z"},
       {.normal = true},
       [](const Film& film, int x, int y) { return film.normal(x, y); }},
      {"albedo",
       {"R", "G", "B"},
       {.albedo = true},
       [](const Film& film, int x, int y) { return film.albedo(x, y); }},
      {"samples", {"Y"}, {}, [](const Film& film, int x, int y) { return Vec3d(film.sample_count(x, y)); }},
      {kVariance,
       {"Y"},
       {},
       [](const Film& film, int x, int y) { return Vec3d(film.variance_of_mean(x, y)); }},
  };
  return kinds;
}

const LayerKind& layer_kind(const std::string& name) {
  std::string known;
  for (const LayerKind& kind : layer_kinds()) {
    if (name == kind.name) return kind;
    known += (known.empty() ? "" : ", ") + std::string(kind.name);
  }
  known += std::string(", ") + kDenoiseAov;
  throw Error(ErrorCode::kBadParameter, "", "unknown AOV \"" + name + "\"; expected one of " + known);
}

FilmLayers needs_of(const std::string& name) {
  if (name == kDenoiseAov) return {.normal = true, .albedo = true, .classes = true};
  return layer_kind(name).needs;
}

ImageLayer make_layer(const Film& film, const LayerKind& kind) {
  ImageLayer layer{kind.name, kind.channels, {}};
  layer.values.reserve(film.pixel_count() * kind.channels.size());
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const Vec3d value = kind.value(film, x, y);
      for (int c = 0; c < static_cast<int>(kind.channels.size()); ++c) {
        layer.values.push_back(static_cast<float>(value[c]));
      }
    }
  }
  if (layer.name == kVariance) {
    const std::vector<float> shares = film.variance_shares();
    for (std::size_t i = 0; i < shares.size(); ++i) layer.values[i] *= shares[i];
  }
  return layer;
}

}  // namespace

FilmLayers film_layers(const std::vector<std::string>& aovs) {
  FilmLayers layers;
  for (const std::string& name : aovs) {
    const FilmLayers needs = needs_of(name);
    layers.depth |= needs.depth;
    layers.normal |= needs.normal;
    layers.albedo |= needs.albedo;
    layers.classes |= needs.classes;
  }
  return layers;
}

Image image_from_film(const Film& film, const std::vector<std::string>& aovs, bool transparent) {
  Image image(film.width(), film.height());
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const Vec3f radiance(film.mean(x, y));
      float* pixel = image.pixel(x, y);
      pixel[0] = radiance.x;
      pixel[1] = radiance.y;
      pixel[2] = radiance.z;
      pixel[3] = transparent ? static_cast<float>(film.alpha(x, y)) : 1.0f;
    }
  }
  for (const std::string& name : aovs) {
    const FilmLayers needs = needs_of(name), has = film.layers();
    if ((needs.depth && !has.depth) || (needs.normal && !has.normal) || (needs.albedo && !has.albedo) ||
        (needs.classes && !has.classes)) {
      throw Error(ErrorCode::kBadParameter, "", "the film does not keep the AOV \"" + name + "\"");
    }
    if (name == kDenoiseAov || image.layer(name) != nullptr) continue;
    image.layers.push_back(make_layer(film, layer_kind(name)));
  }
  return image;
}

}  // namespace voxlume
