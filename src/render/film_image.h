#pragma once
#include <string>
#include <vector>

#include "film/film.h"
#include "voxlume/image.h"

namespace voxlume {

/// The film's layers that these AOV names (ImageDescription::aovs) need.
/// Throws Error kBadParameter for an unknown name, listing the known ones.
FilmLayers film_layers(const std::vector<std::string>& aovs);

/// The picture on the film: means, and a layer for each name in `aovs`, as the table in voxlume/image.h says.
/// A is the film's alpha when the background is transparent (the radiance is then premultiplied), else 1.
/// Throws Error kBadParameter for an unknown name or one whose sums the film does not keep.
Image image_from_film(const Film& film, const std::vector<std::string>& aovs, bool transparent);

}  // namespace voxlume
