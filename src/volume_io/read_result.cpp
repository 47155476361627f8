#include "volume_io/read_result.h"

#include <nlohmann/json.hpp>

namespace voxlume {
namespace {

using nlohmann::json;

std::string one_json_line(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string encode_volume(const StagedVolume& staged) {
  const Volume& volume = staged.volume;
  json value = {{"size", volume.size},
                {"type", static_cast<int>(volume.type)},
                {"spacing_mm", volume.spacing_mm},
                {"origin_mm", volume.origin_mm},
                {"direction", volume.direction},
                {"modality", volume.modality},
                {"format", volume.format},
                {"warnings", volume.warnings}};
  if (staged.in_file) {
    // As numbers: a file name may be bytes that are no text.
    const std::string& name = staged.in_file->path.native();
    value["data_path"] = std::vector<std::uint8_t>(name.begin(), name.end());
    value["data_offset"] = staged.in_file->offset_bytes;
  }
  return one_json_line(value);
}

std::string encode_error(const Error& error) {
  return one_json_line(
      {{"error", static_cast<int>(error.code())}, {"where", error.where()}, {"message", error.message()}});
}

StagedVolume decode_result(const std::string& line) {
  try {
    const json value = json::parse(line);
    if (value.contains("error")) {
      throw Error(static_cast<ErrorCode>(value.at("error").get<int>()), value.at("where"),
                  value.at("message"));
    }
    StagedVolume staged;
    Volume& volume = staged.volume;
    volume.size = value.at("size");
    volume.type = static_cast<VoxelType>(value.at("type").get<int>());
    volume.spacing_mm = value.at("spacing_mm");
    volume.origin_mm = value.at("origin_mm");
    volume.direction = value.at("direction");
    volume.modality = value.at("modality");
    volume.format = value.at("format");
    volume.warnings = value.at("warnings").get<std::vector<std::string>>();
    if (value.contains("data_path")) {
      const auto name = value.at("data_path").get<std::vector<std::uint8_t>>();
      staged.in_file = VoxelsInFile{std::string(name.begin(), name.end()), value.at("data_offset")};
    }
    return staged;
  } catch (const json::exception&) {
    throw Error(ErrorCode::kInternal, "", "the reader's answer cannot be understood");
  }
}

}  // namespace voxlume
