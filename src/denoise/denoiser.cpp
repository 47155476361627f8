#include "denoise/denoiser.h"

#include <fmt/format.h>

#include "denoise/atrous.h"
#include "denoise/bilateral.h"
#include "denoise/decoupled.h"
#include "denoise/oidn.h"
#include "denoise/svgf.h"
#include "denoise/wrls.h"
#include "denoise/xu2024.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

std::unique_ptr<Denoiser> make_decoupled() { return std::make_unique<DecoupledDenoiser>(); }

std::unique_ptr<Denoiser> make_xu2024() { return std::make_unique<Xu2024Denoiser>(); }

constexpr DenoiserNeeds kGuides{.normal = true, .albedo = true};

}  // namespace

const std::vector<DenoiserKind>& denoiser_kinds() {
  static const std::vector<DenoiserKind> kinds{
      {"decoupled",
       "scattering and arriving light filtered apart (xu2024)",
       {.normal = true, .albedo = true, .classes = true},
       true,
       make_decoupled},
      {"svgf", "SVGF (schied2017)", kGuides, true, make_svgf},
      {"asvgf", "A-SVGF (schied2018)", {.normal = true, .albedo = true, .gradients = true}, true, make_asvgf},
      {"atrous", "edge-avoiding a-trous wavelets", kGuides, false, make_atrous},
      {"bilateral", "joint bilateral filter", kGuides, false, make_bilateral},
      {"wrls", "weighted recursive least squares (iglesias2020)", {}, true, make_wrls<{}>},
      {"rls", "wrls without weights", {}, true, make_wrls<{.weighted = false}>},
      {"wrls-no-feature", "wrls as a mean over time", {}, true, make_wrls<{.feature = false}>},
      {"rls-no-feature",
       "rls as a mean over time",
       {},
       true,
       make_wrls<{.weighted = false, .feature = false}>},
      {"xu2024",
       "decoupled with the history of its paper",
       {.normal = true, .albedo = true, .classes = true},
       true,
       make_xu2024},
      {"oidn", "Open Image Denoise, where installed", kGuides, false, make_oidn},
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
