#include "volume_io/voxel_stream.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "base/fail.h"

namespace voxlume {
namespace {

constexpr std::uint64_t kChunkBytes = 1 << 18;

/// Calls read(to, bytes), which gives how many it read, for one part of `bytes` after another, until one is
/// short; gives how many were read in all.
template <class Read>
std::uint64_t read_in_parts(void* voxels, std::uint64_t bytes, const Progress& progress, Read&& read) {
  ProgressCounter counter(static_cast<std::int64_t>(bytes), progress);
  std::uint64_t done = 0;
  while (done < bytes) {
    const std::uint64_t part = std::min(kChunkBytes, bytes - done);
    const std::uint64_t got = read(static_cast<unsigned char*>(voxels) + done, part);
    done += got;
    counter.add(static_cast<std::int64_t>(got));
    if (got < part) break;
  }
  return done;
}

std::ifstream open_at(const std::filesystem::path& path, std::uint64_t offset_bytes) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(ErrorCode::kFileNotFound, path, "cannot open this file for reading");
  file.seekg(static_cast<std::streamoff>(offset_bytes));
  return file;
}

/// zlib's inflate with its state freed.
class Inflater {
 public:
  explicit Inflater(const std::filesystem::path& path) : path_(path) {
    if (inflateInit2(&stream_, 15 + 32) != Z_OK) fail(ErrorCode::kOutOfMemory, path_, "zlib cannot start");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Writes up to `bytes` bytes; returns how many. Fewer than asked only at the end of the data.
  std::uint64_t read(std::ifstream& file, unsigned char* to, std::uint64_t bytes) {
    std::uint64_t done = 0;
    while (done < bytes && !ended_) {
      if (stream_.avail_in == 0 && !refill(file))
        fail(ErrorCode::kBadFormat, path_, "compressed data is cut short; copy or download the file again");
      const auto room = static_cast<uInt>(std::min<std::uint64_t>(bytes - done, 1u << 30));
      stream_.next_out = to + done;
      stream_.avail_out = room;
      const int status = inflate(&stream_, Z_NO_FLUSH);
      done += room - stream_.avail_out;
      if (status == Z_STREAM_END) {
        next_member(file);
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        fail(ErrorCode::kBadFormat, path_,
             fmt::format("compressed data is damaged ({}); copy or download the file again",
                         stream_.msg ? stream_.msg : "zlib error"));
      }
    }
    return done;
  }

 private:
  bool refill(std::ifstream& file) {
    file.read(reinterpret_cast<char*>(input_.data()), static_cast<std::streamsize>(input_.size()));
    stream_.next_in = input_.data();
    stream_.avail_in = static_cast<uInt>(file.gcount());
    return stream_.avail_in > 0;
  }
  // Anything after a member but another gzip member is padding and ends the data.
  void next_member(std::ifstream& file) {
    if (stream_.avail_in == 0) refill(file);
    ended_ = stream_.avail_in == 0 || *stream_.next_in != 0x1f;
    if (!ended_) inflateReset(&stream_);
  }

  const std::filesystem::path& path_;
  z_stream stream_{};
  std::array<unsigned char, kChunkBytes> input_;
  bool ended_ = false;
};

template <typename T>
void parse_numbers(const std::filesystem::path& path, std::ifstream& file, T* voxels, std::uint64_t count,
                   const Progress& progress) {
  std::string word;
  ProgressCounter counter(static_cast<std::int64_t>(count), progress);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!(file >> word)) {
      fail(ErrorCode::kBadFormat, path, fmt::format("expected {} numbers of voxel data, found {}", count, i));
    }
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      fail(ErrorCode::kBadFormat, path,
           fmt::format("voxel {} is \"{}\"; expected a number of its type", i, word.substr(0, 40)));
    }
    std::memcpy(voxels + i, &value, sizeof(T));
    counter.add();
  }
}

template <typename Word>
void swap_words(void* voxels, std::uint64_t count) {
  auto* bytes = static_cast<unsigned char*>(voxels);
  for (std::uint64_t i = 0; i < count; ++i) {
    Word word;
    std::memcpy(&word, bytes + i * sizeof(Word), sizeof(Word));
    if constexpr (sizeof(Word) == 2) word = __builtin_bswap16(word);
    if constexpr (sizeof(Word) == 4) word = __builtin_bswap32(word);
    if constexpr (sizeof(Word) == 8) word = __builtin_bswap64(word);
    std::memcpy(bytes + i * sizeof(Word), &word, sizeof(Word));
  }
}

}  // namespace

void read_plain(const std::filesystem::path& path, std::uint64_t offset_bytes, void* voxels,
                std::uint64_t bytes, const Progress& progress) {
  std::ifstream file = open_at(path, offset_bytes);
  const std::uint64_t found =
      read_in_parts(voxels, bytes, progress, [&](unsigned char* to, std::uint64_t part) {
        file.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(part));
        return static_cast<std::uint64_t>(file.gcount());
      });
  if (found < bytes) {
    fail(ErrorCode::kBadFormat, path, fmt::format("expected {} bytes of voxels, file has {}", bytes, found));
  }
}

void read_deflated(const std::filesystem::path& path, std::uint64_t offset_bytes, std::uint64_t skip_bytes,
                   void* voxels, std::uint64_t bytes, const Progress& progress) {
  std::ifstream file = open_at(path, offset_bytes);
  const auto inflater = std::make_unique<Inflater>(path);
  std::vector<unsigned char> scratch(kChunkBytes);
  for (std::uint64_t left = skip_bytes; left > 0;) {
    const std::uint64_t got = inflater->read(file, scratch.data(), std::min(left, kChunkBytes));
    if (got == 0) fail(ErrorCode::kBadFormat, path, "compressed data ends before the voxels begin");
    left -= got;
  }
  const std::uint64_t found =
      read_in_parts(voxels, bytes, progress,
                    [&](unsigned char* to, std::uint64_t part) { return inflater->read(file, to, part); });
  if (found < bytes) {
    fail(ErrorCode::kBadFormat, path, fmt::format("expected {} bytes of voxels, file has {}", bytes, found));
  }
  // The checksum stands at the end of the stream.
  while (inflater->read(file, scratch.data(), kChunkBytes) > 0) {
  }
}

void read_deflated_start(const std::filesystem::path& path, void* start, std::uint64_t bytes) {
  std::ifstream file = open_at(path, 0);
  const auto inflater = std::make_unique<Inflater>(path);
  if (inflater->read(file, static_cast<unsigned char*>(start), bytes) < bytes) {
    fail(ErrorCode::kBadFormat, path, "compressed data ends inside the header");
  }
}

bool starts_with_gzip(const std::filesystem::path& path) {
  std::ifstream file = open_at(path, 0);
  return file.get() == 0x1f && file.get() == 0x8b;
}

void read_text(const std::filesystem::path& path, std::uint64_t offset_bytes, VoxelType type, void* voxels,
               std::uint64_t count, const Progress& progress) {
  std::ifstream file = open_at(path, offset_bytes);
  switch (type) {
    case VoxelType::kU8:
      return parse_numbers(path, file, static_cast<std::uint8_t*>(voxels), count, progress);
    case VoxelType::kI8:
      return parse_numbers(path, file, static_cast<std::int8_t*>(voxels), count, progress);
    case VoxelType::kU16:
      return parse_numbers(path, file, static_cast<std::uint16_t*>(voxels), count, progress);
    case VoxelType::kI16:
      return parse_numbers(path, file, static_cast<std::int16_t*>(voxels), count, progress);
    case VoxelType::kU32:
      return parse_numbers(path, file, static_cast<std::uint32_t*>(voxels), count, progress);
    case VoxelType::kI32:
      return parse_numbers(path, file, static_cast<std::int32_t*>(voxels), count, progress);
    case VoxelType::kF32:
      return parse_numbers(path, file, static_cast<float*>(voxels), count, progress);
    case VoxelType::kF64:
      return parse_numbers(path, file, static_cast<double*>(voxels), count, progress);
  }
}

void swap_bytes(void* voxels, std::uint64_t count, std::size_t value_bytes) {
  if (value_bytes == 2) swap_words<std::uint16_t>(voxels, count);
  if (value_bytes == 4) swap_words<std::uint32_t>(voxels, count);
  if (value_bytes == 8) swap_words<std::uint64_t>(voxels, count);
}

void check_deflated_size(const std::filesystem::path& path, std::uint64_t file_bytes,
                         std::uint64_t voxel_bytes) {
  constexpr std::uint64_t kMaxRatio = 1032;
  if (voxel_bytes / kMaxRatio > file_bytes) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("the header promises {} bytes of voxels; {} bytes of data cannot hold them", voxel_bytes,
                     file_bytes));
  }
}

}  // namespace voxlume
