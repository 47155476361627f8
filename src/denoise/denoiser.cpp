#include "denoise/denoiser.h"

#include <fmt/format.h>

#include "denoise/atrous.h"
#include "denoise/bilateral.h"
#include "denoise/decoupled.h"
#include "denoise/oidn.h"
#include "denoise/svgf.h"
#include "denoise/wrls.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

template <class Method>
std::unique_ptr<Denoiser> make() {
  return std::make_unique<Method>();
}

}  // namespace

const std::vector<DenoiserKind>& denoiser_kinds() {
  static const std::vector<DenoiserKind> kinds{
      {"decoupled",
       "scattering and arriving light filtered apart, with history (xu2024)",
       {.normal = true, .albedo = true, .classes = true},
       make<DecoupledDenoiser>},
      {"svgf", "SVGF (schied2017)", {.normal = true, .albedo = true}, make_svgf},
      {"asvgf", "A-SVGF (schied2018)", {.normal = true, .albedo = true, .gradients = true}, make_asvgf},
      {"atrous", "edge-avoiding a-trous wavelets, one frame", {.normal = true, .albedo = true}, make_atrous},
      {"bilateral", "joint bilateral filter, one frame", {.normal = true, .albedo = true}, make_bilateral},
      {"wrls", "weighted recursive least squares over time (iglesias2020)", {}, make_wrls<{}>},
      {"rls", "wrls without weights", {}, make_wrls<{.weighted = false}>},
      {"wrls-no-feature", "wrls as a mean over time", {}, make_wrls<{.feature = false}>},
      {"rls-no-feature", "rls as a mean over time", {}, make_wrls<{.weighted = false, .feature = false}>},
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
