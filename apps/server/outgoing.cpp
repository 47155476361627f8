#include "server/outgoing.h"

namespace voxlume::server {

using nlohmann::json;

namespace {

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

}  // namespace

json status_json(const OpeningStatus& status) {
  json out{{"type", "status"}, {"stage", status.stage}};
  if (!status.name.empty()) out["what"] = status.name;
  if (!status.message.empty()) out["message"] = status.message;
  if (status.share) out["share"] = *status.share;
  return out;
}

json progress_json(const RenderProgress& progress) {
  return {{"type", "progress"},
          {"spp", progress.spp},
          {"noise", or_null(progress.noise)},
          {"remaining_s", or_null(progress.remaining_s)},
          {"samples_per_s", progress.samples_per_s}};
}

json split_json(const std::optional<double>& at) { return {{"type", "split"}, {"at", or_null(at)}}; }

json preset_drawn_json(const std::string& preset) { return {{"type", "preset_drawn"}, {"name", preset}}; }

json failure_json(const std::optional<PageMessage>& message, std::string_view text, const Error& error) {
  if (message) {
    if (const auto* open = std::get_if<OpenMessage>(&*message))
      return status_json({"failed", file_name(open->path), error.what(), {}});
    if (std::holds_alternative<LoadMessage>(*message))
      return status_json({"failed", "scene", error.what(), {}});
    if (const auto* wish = std::get_if<ExportMessage>(&*message))
      return {{"type", "export"}, {"state", "failed"},  {"frames_done", 0},
              {"frames", 0},      {"file", wish->file}, {"message", error.message()}};
  }
  const auto seq = seq_of(text);
  return {{"type", "refused"},
          {"seq", seq ? json(*seq) : json(nullptr)},
          {"where", error.where()},
          {"message", error.message()}};
}

}  // namespace voxlume::server
