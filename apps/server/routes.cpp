#include "server/routes.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/file_extension.h"
#include "grid/slice.h"
#include "render/picture.h"
#include "scene/scene_file.h"
#include "server/folder_listing.h"
#include "server/volume_facts.h"
#include "voxlume/error.h"

namespace voxlume::server {
namespace {

using Status = Reply::Status;

constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; "
    "worker-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

constexpr const char* kNoPage =
    "<!doctype html><meta charset=utf-8><title>voxlume</title>"
    "<body style='font:16px/1.5 sans-serif;max-width:40em;margin:4em auto'>"
    "<h1>The page is not built</h1><p>The server works, but its page is not there. "
    "<code>./vx build</code> in the source folder builds it into <code>build/web</code>; then reload. "
    "<code>VOXLUME_PAGE</code> names another folder.</p>";

Status status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kFileNotFound:
      return Status::not_found;
    case ErrorCode::kOutOfMemory:
    case ErrorCode::kInternal:
      return Status::service_unavailable;
    default:
      return Status::bad_request;
  }
}

/// Whether the request is about what is open.
bool is_of_volume(const std::string& name) {
  for (const char* known :
       {"volume", "labels", "histogram", "histogram2", "slice", "picture.png", "picture.exr", "scene.json"})
    if (name == known) return true;
  return name.starts_with("preset/");
}

std::optional<double> number(const std::string& text) {
  double out = 0;
  const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (failed != std::errc{} || stop != text.data() + text.size() || !std::isfinite(out)) return std::nullopt;
  return out;
}

/// As a file to be saved under `name`.
Reply attachment(Reply reply, const std::string& name) {
  std::string plain = name;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c < 0x20 || c > 0x7E || c == '"' || c == '\\'; }, '_');
  reply.headers.emplace_back("Content-Disposition", "attachment; filename=\"" + plain + "\"");
  return reply;
}

Reply slice_reply(const Slice& slice) {
  std::string bytes;
  bytes.reserve(slice.samples.size() * 2);
  for (const std::uint16_t u : slice.samples) {
    bytes += static_cast<char>(u & 255);
    bytes += static_cast<char>(u >> 8);
  }
  Reply reply;
  reply.type = "application/octet-stream";
  reply.body = std::make_shared<const std::string>(std::move(bytes));
  reply.headers.emplace_back("X-Slice", text_of({{"width", slice.width},
                                                 {"height", slice.height},
                                                 {"origin_mm", slice.origin_mm},
                                                 {"spacing_mm", slice.spacing_mm},
                                                 {"scale", slice.scale},
                                                 {"offset", slice.offset}}));
  return reply;
}

}  // namespace

void Routes::get(const Target& target, std::string_view if_none_match, const Respond& respond) const {
  if (!target.path.starts_with("/api/")) return respond(page(target.path, if_none_match));
  try {
    api(target, respond);
  } catch (const Error& error) {
    respond(error_reply(status_of(error.code()), error.what()));
  } catch (const std::exception& error) {
    respond(error_reply(Status::service_unavailable, error.what()));
  }
}

Reply Routes::page(const std::string& path, std::string_view if_none_match) const {
  Reply reply;
  if (path == "/" && !page_.exists()) {
    reply.type = "text/html; charset=utf-8";
    reply.body = std::make_shared<const std::string>(kNoPage);
  } else {
    const auto file = page_.file(path);
    if (!file) return error_reply(Status::not_found, "there is no such page");
    reply.headers.emplace_back("ETag", file->tag);
    if (if_none_match == file->tag) {
      reply.status = Status::not_modified;
    } else {
      reply.type = file->type;
      reply.file = file->path;
    }
  }
  reply.headers.emplace_back("Content-Security-Policy", kPolicy);
  reply.headers.emplace_back("Cache-Control", "no-cache");
  return reply;
}

void Routes::api(const Target& target, const Respond& respond) const {
  const std::string name = target.path.substr(std::string_view("/api/").size());
  if (name == "files")  // of a disk that may be slow
    return work(respond, [&roots = view_.roots(), path = target.value("path")] {
      return json_reply(text_of(folder_listing(roots, path)));
    });
  if (name.starts_with("export/")) return respond(finished_export(name.substr(7)));
  if (view_.document() == nullptr && is_of_volume(name))
    return respond(error_reply(Status::not_found, "nothing is open"));
  if (name == "volume")
    return work(respond, [volume = view_.volume()] {
      const Session& session = volume->session->session();
      return json_reply(text_of(volume_json(volume->name, session.volume(), session.statistics())));
    });
  if (name == "labels") return labels(respond);
  if (name == "histogram") return histogram(target, respond);
  if (name == "histogram2") return joint_histogram(target, respond);
  if (name == "slice") return slice(target, respond);
  if (name == "picture.png" || name == "picture.exr") return picture(name.substr(7), respond);
  if (name == "scene.json") return respond(scene_file());
  if (name.starts_with("preset/") && name.ends_with(".png"))
    return respond(thumbnail(name.substr(7, name.size() - 11)));
  respond(error_reply(Status::not_found, "there is no such request"));
}

void Routes::work(const Respond& respond, std::function<Reply()> job) const {
  view_.work([respond, job = std::move(job)] {
    try {
      respond(job());
    } catch (const Error& error) {
      respond(error_reply(status_of(error.code()), error.what()));
    } catch (const std::exception& error) {
      respond(error_reply(Status::service_unavailable, error.what()));
    }
  });
}

void Routes::labels(const Respond& respond) const {
  work(respond, [volume = view_.volume(), scene = view_.document()->shared_scene()] {
    nlohmann::json out = nlohmann::json::object();
    for (const std::string& name : label_volume_names(*scene))
      out[name] = labels_json(*volume->sides->find(*scene, name));
    return json_reply(text_of(out));
  });
}

void Routes::histogram(const Target& target, const Respond& respond) const {
  work(respond, [volume = view_.volume(), scene = view_.document()->shared_scene(), of = target.value("of")] {
    return json_reply(text_of(histogram_json(volume->sides->find(*scene, of)->statistics)));
  });
}

void Routes::joint_histogram(const Target& target, const Respond& respond) const {
  work(respond, [volume = view_.volume(), scene = view_.document()->shared_scene(), x = target.value("x"),
                 y = target.value("y")] {
    Reply reply = json_reply("");
    reply.body = volume->joint->find(*volume->sides, *scene, x, y);
    return reply;
  });
}

void Routes::slice(const Target& target, const Respond& respond) const {
  SliceRequest request;
  const std::string axis = target.value("axis");
  request.axis = axis == "x" ? 0 : axis == "y" ? 1 : axis == "z" ? 2 : -1;
  const auto place = number(target.value("mm"));
  if (request.axis < 0 || !place)
    return respond(error_reply(Status::bad_request, "expected axis=x, y or z and mm, a number"));
  request.place_mm = *place;
  const std::string of = target.value("of");
  work(respond, [volume = view_.volume(), scene = view_.document()->shared_scene(), of, request]() mutable {
    const Session& session = volume->session->session();
    const auto side = of.empty() || of == "data" ? nullptr : volume->sides->find(*scene, of);
    const VolumeStatistics& statistics = side ? side->statistics : session.statistics();
    request.nearest = side && side->labels;
    request.lower = statistics.lower;
    request.upper = statistics.upper;
    return slice_reply(resample_slice(side ? side->volume : session.volume(), request));
  });
}

void Routes::picture(const std::string& extension, const Respond& respond) const {
  view_.with_still_picture([this, extension, respond](std::shared_ptr<const LiveFrame> frame) {
    if (!frame || view_.document() == nullptr)
      return respond(error_reply(Status::service_unavailable, "the picture is not there yet; ask again"));
    const auto file = view_.temporary_file(extension);
    work(respond, [frame, file, scene = view_.document()->shared_scene(), extension] {
      save_picture(*frame->linear, *scene, file);
      Reply reply;
      reply.type = extension == ".png" ? "image/png" : "image/x-exr";
      reply.file = file;
      reply.remove_file = true;
      return attachment(std::move(reply), "picture" + extension);
    });
  });
}

Reply Routes::scene_file() const {
  SceneDescription scene = view_.document()->scene();
  const std::set<std::string> beside = view_.uploads().name_uploads(scene);
  Reply reply = json_reply(write_scene(scene));
  if (!beside.empty()) {
    constexpr bool kAscii = true;
    reply.headers.emplace_back("X-Beside", nlohmann::json(beside).dump(-1, ' ', kAscii));
  }
  return attachment(std::move(reply), "scene.json");
}

Reply Routes::thumbnail(const std::string& preset) const {
  Reply reply;
  const auto png = view_.thumbnails().find(preset);
  if (!png) return error_reply(Status::not_found, "there is no such picture, or it is not drawn yet");
  reply.body = png;
  reply.type = "image/png";
  return reply;
}

Reply Routes::finished_export(const std::string& file) const {
  Reply reply;
  reply.file = view_.exports().finished(file);
  if (reply.file.empty()) return error_reply(Status::not_found, "there is no such animation");
  const std::string extension = lower_extension(reply.file);
  reply.type = extension == ".mp4" ? "video/mp4" : extension == ".webm" ? "video/webm" : "application/zip";
  return attachment(std::move(reply), file);
}

}  // namespace voxlume::server
