#include "denoise/denoiser.h"

#include <fmt/format.h>

#include "denoise/wrls.h"
#include "voxlume/error.h"

namespace voxlume {

const std::vector<DenoiserKind>& denoiser_kinds() {
  static const std::vector<DenoiserKind> kinds{
      {"wrls", "weighted recursive least squares over time (iglesias2020)", {}, make_wrls<{}>},
      {"rls", "wrls without weights", {}, make_wrls<{.weighted = false}>},
      {"wrls-no-feature", "wrls as a mean over time", {}, make_wrls<{.feature = false}>},
      {"rls-no-feature", "rls as a mean over time", {}, make_wrls<{.weighted = false, .feature = false}>},
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
