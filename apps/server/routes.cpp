#include "server/routes.h"

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

void Routes::api(const Target&, const Respond& respond) const {
  respond(error_reply(Status::not_found, "there is no such request"));
}

}  // namespace voxlume::server
