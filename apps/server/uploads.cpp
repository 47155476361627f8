#include "server/uploads.h"

#include <algorithm>

#include "scene/scene_file.h"
#include "server/header_files.h"
#include "server/main_file.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kDiskReserveBytes = std::uint64_t{256} << 20;  // left for others
constexpr std::size_t kMostNameBytes = 200;

std::uint64_t bytes_of(const fs::path& file) {
  std::error_code failed;
  const auto bytes = fs::file_size(file, failed);
  return failed ? 0 : bytes;
}

void check_name(const std::string& name, const char* where) {
  if (!is_plain_file_name(name))
    throw Error(ErrorCode::kBadParameter, where, "expected the name of a file, without folders");
}

}  // namespace

bool is_plain_file_name(const std::string& name) {
  return !name.empty() && name.size() <= kMostNameBytes && name.front() != '.' &&
         std::none_of(name.begin(), name.end(), [](char c) {
           return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '/' || c == '\\';
         });
}

Uploads::Uploads(fs::path folder, std::uint64_t most_bytes, std::size_t most_files_of_set)
    : folder_(std::move(folder)), most_bytes_(most_bytes), most_files_of_set_(most_files_of_set) {
  fs::create_directories(folder_);
}

std::uint64_t Uploads::room() const {
  std::uint64_t used = used_bytes_;
  for (const Incoming* one : incoming_) used += bytes_of(one->path());
  const std::uint64_t left = used < most_bytes_ ? most_bytes_ - used : 0;
  std::error_code failed;
  const fs::space_info disk = fs::space(folder_, failed);
  if (failed) return left;
  return std::min<std::uint64_t>(left,
                                 disk.available > kDiskReserveBytes ? disk.available - kDiskReserveBytes : 0);
}

std::unique_ptr<Uploads::Incoming> Uploads::begin(const std::string& name,
                                                  const std::optional<UploadSet>& set) {
  check_name(name, "name");
  if (set) {
    check_name(set->id, "set");
    check_name(set->folder, "folder");
    if (set_of(*set).files++ >= most_files_of_set_) {
      drop(set->id);
      throw Error(ErrorCode::kUnsupported, "set",
                  "expected at most " + std::to_string(most_files_of_set_) + " files");
    }
  }
  return std::make_unique<Incoming>(*this, name, set ? set->id : "");
}

fs::path Uploads::new_folder() {
  const fs::path folder = folder_ / std::to_string(++count_);
  fs::create_directories(folder);
  return folder;
}

Uploads::Set& Uploads::set_of(const UploadSet& named) {
  Set& set = sets_[named.id];
  if (!set.folder.empty()) return set;
  set.folder = new_folder() / named.folder;
  fs::create_directories(set.folder);
  return set;
}

void Uploads::drop(std::string id) {
  const auto found = sets_.find(id);
  if (found == sets_.end()) return;
  std::error_code ignored;
  fs::remove_all(found->second.folder.parent_path(), ignored);
  used_bytes_ -= found->second.bytes;
  sets_.erase(found);
}

fs::path Uploads::find(const std::string& name) const {
  const auto found = newest_.find(fs::path(name).lexically_normal().string());
  return found == newest_.end() ? fs::path() : found->second;
}

bool Uploads::contains(const fs::path& path) const {
  return std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end()).first == folder_.end();
}

fs::path Uploads::opened_as(const fs::path& path) {
  if (!contains(path)) return path;
  const auto set =
      std::find_if(sets_.begin(), sets_.end(), [&](const auto& one) { return one.second.folder == path; });
  if (set == sets_.end()) return main_file(path);
  try {
    const fs::path file = main_file(path);
    newest_[path.filename().string()] = path;
    for (const auto& entry : fs::directory_iterator(path))
      newest_[entry.path().filename().string()] = entry.path();
    sets_.erase(set);
    return file;
  } catch (const Error&) {
    drop(set->first);
    throw;
  }
}

std::set<std::string> Uploads::name_uploads(SceneDescription& scene) const {
  std::map<std::string, fs::path> named;
  for_each_path(scene, [&](std::string& path) {
    if (!contains(path)) return;
    const std::string name = fs::path(path).filename().string();
    if (named.emplace(name, path).first->second != path)
      throw Error(ErrorCode::kBadParameter, name,
                  "two files of that name were uploaded, which a scene file cannot tell apart; upload one "
                  "of them under another name");
    path = name == kPhantomPath ? "./" + name : name;
  });
  std::set<std::string> names;
  for (const auto& [name, path] : named) {
    names.insert(name);
    for (const std::string& voxels : files_named_in_header(path)) names.insert(voxels);
  }
  return names;
}

Uploads::Incoming::Incoming(Uploads& uploads, std::string name, std::string set)
    : uploads_(uploads.self_),
      name_(std::move(name)),
      set_(std::move(set)),
      path_(uploads.folder_ / (".part-" + std::to_string(++uploads.count_))) {
  uploads.incoming_.insert(this);
}

Uploads::Incoming::~Incoming() {
  std::error_code ignored;
  if (!finished_) fs::remove(path_, ignored);
  const auto uploads = uploads_.lock();
  if (!uploads) return;
  (*uploads)->incoming_.erase(this);
  if (!finished_) (*uploads)->drop(set_);
}

fs::path Uploads::Incoming::finish() {
  Uploads& uploads = **uploads_.lock();
  const auto set = uploads.sets_.find(set_);
  const bool of_set = set != uploads.sets_.end();
  if (!set_.empty() && !of_set)
    throw Error(ErrorCode::kBadParameter, "set", "it is complete, or a file of it broke off");
  const fs::path whole = (of_set ? set->second.folder : uploads.new_folder()) / name_;
  std::error_code failed;
  if (fs::exists(whole, failed))
    throw Error(ErrorCode::kBadParameter, "name", "the set has a file called " + name_);
  const std::uint64_t bytes = bytes_of(path_);
  if (!failed) fs::rename(path_, whole, failed);
  if (failed) throw Error(ErrorCode::kInternal, name_, failed.message());
  finished_ = true;
  uploads.used_bytes_ += bytes;
  if (!of_set) return uploads.newest_[name_] = whole;
  set->second.bytes += bytes;
  return set->second.folder;
}

}  // namespace voxlume::server
