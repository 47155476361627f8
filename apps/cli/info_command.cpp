#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "accel/hierarchy.h"
#include "cli/commands.h"
#include "cli/scene_flags.h"
#include "cli/terminal.h"
#include "grid/volume_statistics.h"
#include "scene/labels.h"
#include "scene/open_volume.h"
#include "scene/validate.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPercents[] = {0.1, 1, 5, 25, 50, 75, 95, 99, 99.9};

/// Toward which side each index axis points most: L R, P A, S I.
std::string orientation_code(const Volume& volume) {
  std::string code;
  for (int axis = 0; axis < 3; ++axis) {
    int row = 0;
    for (int r = 1; r < 3; ++r) {
      if (std::abs(volume.direction[r * 3 + axis]) > std::abs(volume.direction[row * 3 + axis])) row = r;
    }
    code += (volume.direction[row * 3 + axis] >= 0 ? "LPS" : "RAI")[row];
  }
  return code;
}

/// Voxels, and the value range (two floats) and majorant (one) of every finest cell. The film comes on top.
std::size_t render_bytes(const Volume& volume, const GridView& grid) {
  const int edge = default_hierarchy_voxels(grid);
  std::size_t cells = 1;
  for (const auto n : volume.size) cells *= static_cast<std::size_t>((n + edge - 1) / edge + 1);
  return volume.byte_count() + cells * 3 * sizeof(float);
}

/// Value, name and voxel count of every label that the files beside the volume name; empty where there are
/// none.
Json named_labels(const Volume& volume, const VolumeStatistics& statistics, const std::string& path) {
  Json labels = Json::array();
  constexpr float kMaxLabel = 65535;  // the histogram counts single values up to here
  if (voxel_bytes(volume.type) > 2 || !(statistics.upper >= 1 && statistics.upper <= kMaxLabel))
    return labels;
  LabelTable table;
  try {
    table = read_label_table(path, {}, static_cast<std::size_t>(statistics.upper) + 1);
  } catch (const Error&) {
    return labels;  // a text beside the volume that is about something else
  }
  for (const auto& [value, count] : statistics.histogram) {
    if (value < 0 || table.names[static_cast<std::size_t>(value)].empty()) continue;
    labels.push_back(
        {{"value", value}, {"name", table.names[static_cast<std::size_t>(value)]}, {"voxels", count}});
  }
  return labels;
}

Json describe(const Volume& volume, const std::string& path, const Progress& progress) {
  const GridView grid = make_grid_view(volume);
  const VolumeStatistics statistics = compute_statistics(grid, progress);
  std::array<double, 3> extent{};
  for (std::size_t a = 0; a < 3; ++a) extent[a] = static_cast<double>(volume.size[a]) * volume.spacing_mm[a];
  Json percentiles = Json::object();
  for (const double p : kPercents) percentiles[fmt::format("{}", p)] = statistics.percentile(p / 100);
  return {{"path", path},
          {"format", volume.format},
          {"modality", volume.modality},
          {"size", volume.size},
          {"type", voxel_type_name(volume.type)},
          {"spacing_mm", volume.spacing_mm},
          {"origin_mm", volume.origin_mm},
          {"orientation", orientation_code(volume)},
          {"direction", volume.direction},
          {"extent_mm", extent},
          {"value_range", {statistics.lower, statistics.upper}},
          {"nonfinite_voxels", statistics.nonfinite_voxels},
          {"percentiles", percentiles},
          {"bytes", volume.byte_count()},
          {"render_bytes", render_bytes(volume, grid)},
          {"labels", named_labels(volume, statistics, path)},
          {"warnings", volume.warnings}};
}

std::string number_list(const Json& list, const char* separator = " x ") {
  std::string out;
  for (const Json& x : list) {
    const std::string text = x.is_number_float() ? fmt::format("{:.6g}", x.get<double>()) : x.dump();
    out += (out.empty() ? "" : separator) + text;
  }
  return out;
}

void print_table(const Json& info) {
  const auto line = [](const char* key, const std::string& value) { fmt::print("{:<12} {}\n", key, value); };
  const auto mebibytes = [&](const char* key) {
    return fmt::format("{:.1f} MiB", info[key].get<double>() / 1048576);
  };
  line("format", info["format"].get<std::string>());
  if (const auto modality = info["modality"].get<std::string>(); !modality.empty())
    line("modality", modality);
  line("size", number_list(info["size"]) + " voxels");
  line("type", info["type"].get<std::string>());
  line("spacing", number_list(info["spacing_mm"]) + " mm");
  line("extent", number_list(info["extent_mm"]) + " mm");
  line("origin", number_list(info["origin_mm"], ", ") + " mm (LPS)");
  line("orientation", info["orientation"].get<std::string>());
  for (int r = 0; r < 3; ++r) {
    std::string row;
    for (int c = 0; c < 3; ++c) row += fmt::format("{:>10.6f}", info["direction"][r * 3 + c].get<double>());
    line(r == 0 ? "direction" : "", row);
  }
  line("values", number_list(info["value_range"], " to "));
  if (const auto n = info["nonfinite_voxels"].get<std::uint64_t>())
    line("not finite", fmt::format("{} voxels", n));
  for (const auto& [percent, value] : info["percentiles"].items()) {
    line(percent == "0.1" ? "percentiles" : "", fmt::format("{:>5} %  {:.6g}", percent, value.get<double>()));
  }
  constexpr std::size_t kShownLabels = 12;
  for (std::size_t i = 0; i < std::min(info["labels"].size(), kShownLabels); ++i) {
    const Json& label = info["labels"][i];
    line(i == 0 ? "labels" : "",
         fmt::format("{:>5}  {}", label["value"].get<double>(), label["name"].get<std::string>()));
  }
  if (info["labels"].size() > kShownLabels)
    line("", fmt::format("... {} in all; --json lists them", info["labels"].size()));
  line("memory", mebibytes("bytes") + " voxels, " + mebibytes("render_bytes") + " to render");
}

struct InfoRequest {
  std::string input;
  bool json = false;
  SceneFlags flags;
};

int show_info(const InfoRequest& request) {
  SceneDescription scene = scene_of_input(request.input);
  request.flags.apply(scene);
  ProgressLine progress;
  progress.show("reading " + request.input);
  Volume volume;
  with_scene_name(request.input,
                  [&] { volume = open_volume(scene.volume, progress.of("reading " + request.input)); });
  progress.clear();
  print_warnings(volume.warnings);
  const Json info = describe(volume, scene.volume.path, progress.of("looking over " + request.input));
  progress.clear();
  if (request.json) {
    // Paths need not be UTF-8.
    fmt::print("{}\n", info.dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    print_table(info);
  }
  return kDone;
}

}  // namespace

void add_info_command(CLI::App& program, Action& action) {
  CLI::App* const command =
      program.add_subcommand("info", "Describe a volume: size, orientation, values, memory");
  const auto request = std::make_shared<InfoRequest>();
  command->add_option("INPUT", request->input, "Volume file, DICOM folder, scene (.json) or \"phantom\"")
      ->required();
  command->add_flag("--json", request->json, "Print JSON");
  request->flags.add_volume_flags_to(*command);
  command->footer("\nExamples:\n  voxlume info head-ct.nrrd\n  voxlume info dicom-folder --json");
  command->callback([&action, request] { action = [request] { return show_info(*request); }; });
}

}  // namespace voxlume::cli
