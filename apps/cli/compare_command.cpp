#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "cli/output_file.h"
#include "image_io/image_io.h"
#include "metrics/error_colors.h"
#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "scene/field_info.h"
#include "tonemap/tone_map.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

/// A picture whose values can be compared.
Image read_finite(const std::string& path) {
  Image image = read_image(path);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 == 3 || std::isfinite(image.rgba[i])) continue;
    const std::size_t pixel = i / 4, width = static_cast<std::size_t>(image.width);
    throw Error(ErrorCode::kBadParameter, path,
                fmt::format("has a value that is not finite at pixel {},{}; expected finite values",
                            pixel % width, pixel / width));
  }
  return image;
}

/// The two pictures, and what several uses share.
class Comparison {
 public:
  Comparison(Image image, Image reference) : image_(std::move(image)), reference_(std::move(reference)) {}

  const Image& image() const { return image_; }
  const Image& reference() const { return reference_; }
  const FlipError& flip() {
    if (!flip_) flip_ = voxlume::flip(image_, reference_);
    return *flip_;
  }
  /// Absent where the reference is black.
  const std::optional<FlipError>& flip_hdr() {
    if (!flip_hdr_) flip_hdr_ = voxlume::flip_hdr(image_, reference_);
    return *flip_hdr_;
  }

 private:
  Image image_, reference_;
  std::optional<FlipError> flip_;
  std::optional<std::optional<FlipError>> flip_hdr_;
};

struct Metric {
  const char* name;
  const char* unit;
  std::optional<double> (*measure)(Comparison& pair);
};

std::optional<double> mean_flip_hdr(Comparison& pair) {
  const std::optional<FlipError>& error = pair.flip_hdr();
  return error ? std::optional(error->mean) : std::nullopt;
}

constexpr Metric kMetrics[] = {
    {"rmse", "", [](Comparison& pair) { return std::optional(rmse(pair.image(), pair.reference())); }},
    {"psnr", " dB", [](Comparison& pair) { return psnr(pair.image(), pair.reference()); }},
    {"psnr_hdr", " dB", [](Comparison& pair) { return psnr_hdr(pair.image(), pair.reference()); }},
    {"ssim", "", [](Comparison& pair) { return ssim(pair.image(), pair.reference()); }},
    {"flip", "", [](Comparison& pair) { return std::optional(pair.flip().mean); }},
    {"flip_hdr", "", mean_flip_hdr},
};

constexpr std::string_view kErrorMapKinds[] = {"difference", "flip", "flip_hdr"};

struct CompareRequest {
  std::string image, reference, error_map, error_map_kind;
  std::vector<std::string> metrics;
  bool json = false;
};

std::vector<const Metric*> chosen_metrics(const std::vector<std::string>& names) {
  std::vector<const Metric*> chosen;
  std::vector<std::string_view> known;
  for (const Metric& metric : kMetrics) {
    known.push_back(metric.name);
    if (names.empty()) chosen.push_back(&metric);
  }
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw Error(ErrorCode::kBadParameter, "--metric",
                  "found " + quote_text(name) + ", expected some of " + join_words(known));
    }
    chosen.push_back(&kMetrics[found - known.begin()]);
  }
  return chosen;
}

void check_error_map(const CompareRequest& request) {
  const std::string& kind = request.error_map_kind;
  if (std::find(std::begin(kErrorMapKinds), std::end(kErrorMapKinds), kind) == std::end(kErrorMapKinds)) {
    throw Error(ErrorCode::kBadParameter, "--error-map-kind",
                "found " + quote_text(kind) + ", expected one of " +
                    join_words({std::begin(kErrorMapKinds), std::end(kErrorMapKinds)}));
  }
  if (request.error_map.empty()) return;
  if (picture_format(request.error_map, "--error-map") != PictureFormat::kPng) {
    throw Error(ErrorCode::kUnsupported, "--error-map", "expected a name ending in .png");
  }
  check_not_input(request.error_map, {request.image, request.reference}, "--error-map");
  check_writable(request.error_map, "--error-map");
}

/// The absolute difference of the linear values.
Image difference(const Image& image, const Image& reference) {
  Image out(image.width, image.height);
  for (std::size_t i = 0; i < out.rgba.size(); ++i) {
    out.rgba[i] = i % 4 == 3 ? 1.0f : std::abs(image.rgba[i] - reference.rgba[i]);
  }
  return out;
}

Image8 error_map(Comparison& pair, const std::string& kind) {
  if (kind == "difference") {
    return tone_map(difference(pair.image(), pair.reference()), {.curve = ToneCurve::kSrgb});
  }
  if (kind == "flip") return error_colors(pair.flip());
  if (!pair.flip_hdr()) {
    throw Error(ErrorCode::kBadParameter, "--error-map-kind",
                "found flip_hdr with a black reference, which has no exposures; expected difference or flip");
  }
  return error_colors(*pair.flip_hdr());
}

void print_metrics(Comparison& pair, const std::vector<const Metric*>& metrics, bool json) {
  nlohmann::ordered_json results = nlohmann::ordered_json::object();
  for (const Metric* metric : metrics) {
    const std::optional<double> value = metric->measure(pair);
    results[metric->name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    if (!json) {
      fmt::print("{:<9} {}\n", metric->name, value ? fmt::format("{:.6g}{}", *value, metric->unit) : "none");
    }
  }
  if (json) fmt::print("{}\n", results.dump(2));
}

int compare(const CompareRequest& request) {
  const auto metrics = chosen_metrics(request.metrics);
  check_error_map(request);
  Image image = read_finite(request.image);
  Image reference = read_finite(request.reference);
  if (image.width != reference.width || image.height != reference.height) {
    throw Error(ErrorCode::kBadParameter, request.reference,
                fmt::format("is {} x {} pixels, expected {} x {} as {} has", reference.width,
                            reference.height, image.width, image.height, request.image));
  }
  Comparison pair(std::move(image), std::move(reference));
  print_metrics(pair, metrics, request.json);
  if (!request.error_map.empty()) write_png(error_map(pair, request.error_map_kind), request.error_map);
  return kDone;
}

}  // namespace

void add_compare_command(CLI::App& program, Action& action) {
  CLI::App* const command =
      program.add_subcommand("compare", "Measure how far a picture is from a reference");
  const auto request = std::make_shared<CompareRequest>();
  command->add_option("A", request->image, "Picture: EXR, HDR or PNG")->required();
  command->add_option("B", request->reference, "Reference of the same size")->required();
  command
      ->add_option("--metric", request->metrics,
                   "Some of rmse,psnr,psnr_hdr,ssim,flip,flip_hdr; all by default")
      ->type_name("LIST")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--json", request->json, "Print one flat JSON object; null where a metric has no value");
  CLI::Option* const map =
      command->add_option("--error-map", request->error_map, "Write a picture of where they differ")
          ->type_name("E.png");
  command
      ->add_option("--error-map-kind", request->error_map_kind,
                   "difference (absolute, of the linear values), flip or flip_hdr")
      ->type_name("KIND")
      ->default_val("difference")
      ->needs(map);
  command->footer(
      "\nrmse, psnr_hdr and flip_hdr are of linear values; psnr, ssim and flip of display values (EV 0, "
      "clamped\n"
      "sRGB). psnr is null (none) where the pictures are identical, flip_hdr where B is black. FLIP goes "
      "from 0\n"
      "(no visible difference) to 1, seen at 67 pixels per degree; its maps go from black to pale yellow.\n\n"
      "Example:\n  voxlume compare out.exr reference.exr --metric flip --error-map e.png --error-map-kind "
      "flip");
  command->callback([&action, request] { action = [request] { return compare(*request); }; });
}

}  // namespace voxlume::cli
