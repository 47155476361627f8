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
constexpr const char* kEnded =
    "it is complete, or a file of it was refused or broke off; send all of it again";

std::uint64_t bytes_of(const fs::path& file) {
  std::error_code failed;
  const auto bytes = fs::file_size(file, failed);
  return failed ? 0 : bytes;
}

void check_name(const std::string& name, const char* where) {
  if (!is_plain_file_name(name))
    throw Error(ErrorCode::kBadParameter, where,
                "expected the name of a file, without folders, of at most 200 bytes; rename it");
}

}  // namespace

bool is_plain_file_name(const std::string& name) {
  return !name.empty() && name.size() <= kMostNameBytes && name.front() != '.' &&
         std::none_of(name.begin(), name.end(), [](char c) {
           return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '/' || c == '\\';
         });
}

Uploads::Uploads(fs::path folder, const Limits& limits) : folder_(std::move(folder)), limits_(limits) {
  fs::create_directories(folder_);
}

std::uint64_t Uploads::room() const {
  std::uint64_t used = used_bytes_, awaited = 0;
  for (const Incoming* one : incoming_) {
    const std::uint64_t there = bytes_of(one->path()), all = std::max(there, one->reserved_bytes());
    used += all;
    awaited += all - there;
  }
  const std::uint64_t left = used < limits_.most_bytes ? limits_.most_bytes - used : 0;
  std::error_code failed;
  const fs::space_info disk = fs::space(folder_, failed);
  if (failed) return left;
  const std::uint64_t taken = kDiskReserveBytes + awaited;
  return std::min<std::uint64_t>(left, disk.available > taken ? disk.available - taken : 0);
}

std::unique_ptr<Uploads::Incoming> Uploads::begin(const std::string& name,
                                                  const std::optional<UploadSet>& set) {
  drop_abandoned();
  if (!set) {
    check_name(name, "name");
    return std::make_unique<Incoming>(*this, name, "");
  }
  try {
    check_name(set->id, "set");
    check_name(set->folder, "folder");
    check_name(name, "name");
    if (set_of(*set).files++ >= limits_.most_files_of_set)
      throw Error(ErrorCode::kUnsupported, "set",
                  "expected at most " + std::to_string(limits_.most_files_of_set) + " files");
  } catch (const Error&) {
    drop(set->id);
    throw;
  }
  return std::make_unique<Incoming>(*this, name, set->id);
}

fs::path Uploads::new_folder() {
  const fs::path folder = folder_ / std::to_string(++count_);
  fs::create_directories(folder);
  return folder;
}

fs::path Uploads::folder_of(const fs::path& path) const {
  return folder_ / *path.lexically_relative(folder_).begin();
}

Uploads::Set& Uploads::set_of(const UploadSet& named) {
  if (ended_.contains(named.id)) throw Error(ErrorCode::kBadParameter, "set", kEnded);
  Set& set = sets_[named.id];
  set.touched = Clock::now();
  if (!set.folder.empty()) return set;
  set.folder = new_folder() / named.folder;
  fs::create_directories(set.folder);
  return set;
}

void Uploads::drop(std::string id) {
  const auto found = sets_.find(id);
  if (found == sets_.end()) return;
  remove(found->second.folder.parent_path(), found->second.bytes);
  sets_.erase(found);
  ended_.insert(id);
}

/// Who began them went away between two files.
void Uploads::drop_abandoned() {
  std::set<std::string> abandoned;
  for (const auto& [id, set] : sets_)
    if (Clock::now() - set.touched >= limits_.patience) abandoned.insert(id);
  for (const Incoming* one : incoming_) abandoned.erase(one->set());
  for (const std::string& id : abandoned) drop(id);
}

void Uploads::remove(const fs::path& folder, std::uint64_t bytes) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  used_bytes_ -= bytes;
}

void Uploads::keep(const fs::path& path) {
  if (!contains(path)) return;
  if (const auto found = whole_.find(folder_of(path)); found != whole_.end()) found->second.kept = true;
}

std::string Uploads::with_names_alone(std::string text) const {
  const std::string start = folder_.string() + "/";  // then the number of a folder, and a slash
  for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at)) {
    const std::size_t end = text.find_first_not_of("0123456789", at + start.size());
    if (end == std::string::npos || text[end] != '/') break;
    text.erase(at, end + 1 - at);
  }
  return text;
}

void Uploads::give_up(const fs::path& path) {
  if (!contains(path)) return;
  const auto found = whole_.find(folder_of(path));
  if (found == whole_.end() || found->second.kept) return;
  for (auto& [name, paths] : named_)
    std::erase_if(paths, [&](const fs::path& one) { return folder_of(one) == found->first; });
  remove(found->first, found->second.bytes);
  whole_.erase(found);
}

fs::path Uploads::find(const std::string& name) const {
  const auto found = named_.find(fs::path(name).lexically_normal().string());
  return found == named_.end() || found->second.empty() ? fs::path() : found->second.back();
}

bool Uploads::contains(const fs::path& path) const {
  const auto [end, rest] = std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end());
  return end == folder_.end() && rest != path.end();
}

fs::path Uploads::opened_as(const fs::path& path) {
  if (!contains(path)) return path;
  const auto set =
      std::find_if(sets_.begin(), sets_.end(), [&](const auto& one) { return one.second.folder == path; });
  if (set != sets_.end()) {
    whole_[folder_of(path)] = {set->second.bytes};
    named_[path.filename().string()].push_back(path);
    for (const auto& entry : fs::directory_iterator(path))
      named_[entry.path().filename().string()].push_back(entry.path());
    ended_.insert(set->first);
    sets_.erase(set);
  }
  try {
    return main_file(path);
  } catch (const std::exception&) {
    give_up(path);
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
  if (!set_.empty() && !of_set) throw Error(ErrorCode::kBadParameter, "set", kEnded);
  const fs::path whole = (of_set ? set->second.folder : uploads.new_folder()) / name_;
  std::error_code failed;
  if (fs::exists(whole, failed))
    throw Error(ErrorCode::kBadParameter, "name", "the set has a file called " + name_);
  const std::uint64_t bytes = bytes_of(path_);
  if (!failed) fs::rename(path_, whole, failed);
  if (failed) throw Error(ErrorCode::kInternal, name_, failed.message());
  finished_ = true;
  uploads.used_bytes_ += bytes;
  if (!of_set) {
    uploads.whole_[whole.parent_path()] = {bytes};
    return uploads.named_[name_].emplace_back(whole);
  }
  set->second.bytes += bytes;
  set->second.touched = Clock::now();
  return set->second.folder;
}

}  // namespace voxlume::server
