#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/output_file.h"
#include "image_io/image_io.h"
#include "metrics/metrics.h"
#include "scene/field_info.h"
#include "tonemap/tone_map.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

struct Metric {
  const char* name;
  const char* unit;
  std::optional<double> (*measure)(const Image& image, const Image& reference);
};

constexpr Metric kMetrics[] = {
    {"rmse", "", [](const Image& a, const Image& b) { return std::optional(rmse(a, b)); }},
    {"psnr", " dB", psnr},
    {"psnr_hdr", " dB", psnr_hdr},
    {"ssim", "", ssim},
};

struct CompareRequest {
  std::string image, reference, error_map;
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
    if (name == "flip") {
      throw Error(ErrorCode::kUnsupported, "",
                  "--metric flip is not built yet; available: " + join_words(known));
    }
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw Error(ErrorCode::kBadParameter, "--metric",
                  "found " + quote_text(name) + ", expected some of " + join_words(known));
    }
    chosen.push_back(&kMetrics[found - known.begin()]);
  }
  return chosen;
}

/// The absolute difference of the linear values.
Image difference(const Image& image, const Image& reference) {
  Image out(image.width, image.height);
  for (std::size_t i = 0; i < out.rgba.size(); ++i) {
    out.rgba[i] = i % 4 == 3 ? 1.0f : std::abs(image.rgba[i] - reference.rgba[i]);
  }
  return out;
}

int compare(const CompareRequest& request) {
  const auto metrics = chosen_metrics(request.metrics);
  if (!request.error_map.empty()) {
    if (picture_format(request.error_map, "--error-map") != PictureFormat::kPng) {
      throw Error(ErrorCode::kUnsupported, "--error-map", "expected a name ending in .png");
    }
    check_writable(request.error_map, "--error-map");
  }
  const Image image = read_image(request.image);
  const Image reference = read_image(request.reference);
  if (image.width != reference.width || image.height != reference.height) {
    throw Error(ErrorCode::kBadParameter, request.reference,
                fmt::format("is {} x {} pixels, expected {} x {} as {} has", reference.width,
                            reference.height, image.width, image.height, request.image));
  }
  nlohmann::ordered_json results = nlohmann::ordered_json::object();
  for (const Metric* metric : metrics) {
    const std::optional<double> value = metric->measure(image, reference);
    results[metric->name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    if (!request.json) {
      fmt::print("{:<9} {}\n", metric->name, value ? fmt::format("{:.6g}{}", *value, metric->unit) : "none");
    }
  }
  if (request.json) fmt::print("{}\n", results.dump(2));
  if (!request.error_map.empty()) {
    write_png(tone_map(difference(image, reference), {.curve = ToneCurve::kSrgb}), request.error_map);
  }
  return kDone;
}

}  // namespace

void add_compare_command(CLI::App& program, Action& action) {
  CLI::App* const command =
      program.add_subcommand("compare", "Measure how far a picture is from a reference");
  const auto request = std::make_shared<CompareRequest>();
  command->add_option("A", request->image, "Picture: EXR, HDR or PNG")->required();
  command->add_option("B", request->reference, "Reference of the same size")->required();
  command->add_option("--metric", request->metrics, "Some of psnr,rmse,ssim,psnr_hdr; all by default")
      ->type_name("LIST")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--json", request->json, "Print one flat JSON object; null where a metric has no value");
  command->add_option("--error-map", request->error_map, "Write the absolute difference of the linear values")
      ->type_name("E.png");
  command->footer(
      "\nrmse and psnr_hdr are of linear values; psnr and ssim of display values (EV 0, clamped sRGB).\n"
      "psnr is null (none) where the pictures are identical.\n\n"
      "Example:\n  voxlume compare out.exr reference.exr --metric psnr,rmse --json");
  command->callback([&action, request] { action = [request] { return compare(*request); }; });
}

}  // namespace voxlume::cli
