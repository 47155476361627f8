#include "denoise/denoiser.h"

#include <fmt/format.h>

#include "denoise/atrous.h"
#include "denoise/bilateral.h"
#include "denoise/oidn.h"
#include "denoise/svgf.h"
#include "voxlume/error.h"

namespace voxlume {

const std::vector<DenoiserKind>& denoiser_kinds() {
  static const std::vector<DenoiserKind> kinds{
      {"svgf", "SVGF (schied2017)", {.normal = true, .albedo = true}, make_svgf},
      {"asvgf", "A-SVGF (schied2018)", {.normal = true, .albedo = true, .gradients = true}, make_asvgf},
      {"atrous", "edge-avoiding a-trous wavelets, one frame", {.normal = true, .albedo = true}, make_atrous},
      {"bilateral", "joint bilateral filter, one frame", {.normal = true, .albedo = true}, make_bilateral},
      {"oidn", "Open Image Denoise, where installed", {.normal = true, .albedo = true}, make_oidn},
  };
  return kinds;
}

const DenoiserKind& find_denoiser(std::string_view name) {
  std::string known;
  for (const DenoiserKind& kind : denoiser_kinds()) {
    if (kind.name == name) return kind;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", kind.name);
  }
  throw Error(ErrorCode::kBadParameter, "", fmt::format("denoiser \"{}\"; expected one of {}", name, known));
}

}  // namespace voxlume
