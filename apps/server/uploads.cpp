#include "server/uploads.h"

#include <algorithm>

#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kDiskReserveBytes = std::uint64_t{256} << 20;  // left for others
constexpr std::size_t kMostNameBytes = 200;

}  // namespace

bool is_plain_file_name(const std::string& name) {
  return !name.empty() && name.size() <= kMostNameBytes && name.front() != '.' &&
         std::none_of(name.begin(), name.end(), [](char c) {
           return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '/' || c == '\\';
         });
}

Uploads::Uploads(fs::path folder, std::uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {
  fs::create_directories(folder_);
}

std::uint64_t Uploads::room() const {
  std::uint64_t used = 0;
  std::error_code failed;
  for (auto it = fs::recursive_directory_iterator(folder_, failed);
       !failed && it != fs::recursive_directory_iterator(); it.increment(failed)) {
    std::error_code gone;
    if (!it->is_regular_file(gone)) continue;
    const auto bytes = it->file_size(gone);
    if (!gone) used += bytes;
  }
  const std::uint64_t left = used < most_bytes_ ? most_bytes_ - used : 0;
  const fs::space_info disk = fs::space(folder_, failed);
  if (failed) return left;
  return std::min<std::uint64_t>(left,
                                 disk.available > kDiskReserveBytes ? disk.available - kDiskReserveBytes : 0);
}

std::unique_ptr<Uploads::Incoming> Uploads::begin(const std::string& name) {
  if (!is_plain_file_name(name))
    throw Error(ErrorCode::kBadParameter, "name", "expected the name of a file, without folders");
  return std::make_unique<Incoming>(*this, name, ++count_);
}

Uploads::Incoming::Incoming(Uploads& uploads, std::string name, std::uint64_t number)
    : uploads_(uploads),
      name_(std::move(name)),
      path_(uploads.folder_ / (".part-" + std::to_string(number))) {}

Uploads::Incoming::~Incoming() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

fs::path Uploads::Incoming::finish() {
  // Files that belong together, a header and its voxels, stay together when they are sent once more.
  fs::path whole;
  std::error_code failed;
  for (int number = 1; whole.empty() || fs::exists(whole, failed); ++number)
    whole = uploads_.folder_ / std::to_string(number) / name_;
  fs::create_directories(whole.parent_path(), failed);
  if (!failed) fs::rename(path_, whole, failed);
  if (failed) throw Error(ErrorCode::kInternal, name_, failed.message());
  return whole;
}

}  // namespace voxlume::server
