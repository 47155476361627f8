#include "volume_io/read_result.h"

#include <nlohmann/json.hpp>

namespace voxlume {
namespace {

using nlohmann::json;

std::string one_json_line(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string encode_volume(const Volume& volume) {
  return one_json_line({{"size", volume.size},
                        {"type", static_cast<int>(volume.type)},
                        {"spacing_mm", volume.spacing_mm},
                        {"origin_mm", volume.origin_mm},
                        {"direction", volume.direction},
                        {"modality", volume.modality},
                        {"format", volume.format},
                        {"warnings", volume.warnings}});
}

std::string encode_error(const Error& error) {
  return one_json_line(
      {{"error", static_cast<int>(error.code())}, {"where", error.where()}, {"message", error.message()}});
}

Volume decode_result(const std::string& line) {
  try {
    const json value = json::parse(line);
    if (value.contains("error")) {
      throw Error(static_cast<ErrorCode>(value.at("error").get<int>()), value.at("where"),
                  value.at("message"));
    }
    Volume volume;
    volume.size = value.at("size");
    volume.type = static_cast<VoxelType>(value.at("type").get<int>());
    volume.spacing_mm = value.at("spacing_mm");
    volume.origin_mm = value.at("origin_mm");
    volume.direction = value.at("direction");
    volume.modality = value.at("modality");
    volume.format = value.at("format");
    volume.warnings = value.at("warnings").get<std::vector<std::string>>();
    return volume;
  } catch (const json::exception&) {
    throw Error(ErrorCode::kInternal, "", "the reader's answer cannot be understood");
  }
}

}  // namespace voxlume
