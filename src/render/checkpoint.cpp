#include "render/checkpoint.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <span>

#include "base/atomic_file.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

// The file: Header, fingerprint, the film's accumulators, CRC-32 of all before it. Numbers lie as in memory.
constexpr std::array<char, 8> kMagic{'V', 'X', 'L', 'C', 'H', 'K', 'P', 'T'};
constexpr std::uint32_t kFormatVersion = 2;
constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr std::uint32_t kMaxSide = 65536;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t format_version = kFormatVersion;
  std::uint32_t byte_order = kByteOrder;
  std::uint32_t width = 0, height = 0, tile_size = 0;
  std::uint32_t layer_bits = 0;  // 1 depth, 2 normal, 4 albedo, 8 classes
  std::uint64_t fingerprint_bytes = 0;
  TraceCounters counters;
  double elapsed_s = 0;
};
static_assert(sizeof(Header) == 88 && std::is_trivially_copyable_v<Header>);

using Crc = std::uint32_t;

Crc extend_crc(Crc crc, std::span<const std::byte> bytes) {
  if (bytes.empty()) return crc;  // zlib takes a null pointer for a wish to begin anew
  return static_cast<Crc>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

Header header_of(const RenderState& state, const std::string& fingerprint) {
  const FilmLayers layers = state.film.layers();
  Header header;
  header.width = static_cast<std::uint32_t>(state.film.width());
  header.height = static_cast<std::uint32_t>(state.film.height());
  header.tile_size = static_cast<std::uint32_t>(state.tile_size);
  header.layer_bits = (layers.depth ? 1u : 0u) | (layers.normal ? 2u : 0u) | (layers.albedo ? 4u : 0u) |
                      (layers.classes ? 8u : 0u);
  header.fingerprint_bytes = fingerprint.size();
  header.counters = state.counters;
  header.elapsed_s = state.elapsed_s;
  return header;
}

FilmLayers layers_of(const Header& header) {
  return {.depth = (header.layer_bits & 1u) != 0,
          .normal = (header.layer_bits & 2u) != 0,
          .albedo = (header.layer_bits & 4u) != 0,
          .classes = (header.layer_bits & 8u) != 0};
}

[[noreturn]] void fail_format(const fs::path& path, const std::string& message) {
  throw Error(ErrorCode::kBadFormat, path.string(), message);
}

// Bytes of the film's accumulators; the last is its count of non-finite samples.
std::uint64_t film_bytes(const Header& header) {
  return std::uint64_t{header.width} * header.height * Film::bytes_per_pixel(layers_of(header)) +
         sizeof(std::uint64_t);
}

void check_header(const Header& header, std::uint64_t file_bytes, const fs::path& path) {
  if (header.magic != kMagic) fail_format(path, "is not a checkpoint of voxlume");
  if (header.byte_order != kByteOrder) fail_format(path, "was written by a machine of another byte order");
  if (header.format_version != kFormatVersion) {
    fail_format(path, "has checkpoint format " + std::to_string(header.format_version) + "; expected " +
                          std::to_string(kFormatVersion));
  }
  const auto side_ok = [](std::uint32_t side) { return side >= 1 && side <= kMaxSide; };
  const bool sizes_ok = side_ok(header.width) && side_ok(header.height) && side_ok(header.tile_size) &&
                        header.layer_bits < 16 && header.fingerprint_bytes <= file_bytes;
  if (!sizes_ok) fail_format(path, "is a damaged checkpoint: impossible sizes");
  const std::uint64_t expected = sizeof(Header) + header.fingerprint_bytes + film_bytes(header) + sizeof(Crc);
  if (file_bytes != expected) {
    fail_format(path, "is a damaged checkpoint of " + std::to_string(file_bytes) + " bytes; expected " +
                          std::to_string(expected));
  }
}

// The loop counts samples by tile.
bool counts_uniform(const Film& film, const TileRect& tile) {
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      if (film.sample_count(x, y) != film.sample_count(tile.x0, tile.y0)) return false;
    }
  }
  return true;
}

// A file whose bytes are added to a checksum as they are read.
class ChecksummedReader {
 public:
  explicit ChecksummedReader(const fs::path& path) : path_(path), file_(path, std::ios::binary) {}

  void read(std::span<std::byte> bytes) {
    file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file_) fail_format(path_, "is a damaged checkpoint: it ends too early");
    crc_ = extend_crc(crc_, bytes);
  }
  template <class T>
  T read() {
    T value;
    read(std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }
  Crc crc() const { return crc_; }

 private:
  fs::path path_;
  std::ifstream file_;
  Crc crc_ = 0;
};

}  // namespace

fs::path checkpoint_path(const fs::path& output) {
  fs::path path = output;
  path += ".checkpoint";
  return path;
}

void save_checkpoint(const RenderState& state, const std::string& fingerprint, const fs::path& path) {
  write_file_atomically(path, [&](const fs::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    Crc crc = 0;
    const auto write = [&](std::span<const std::byte> bytes) {
      file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
      crc = extend_crc(crc, bytes);
    };
    const Header header = header_of(state, fingerprint);
    write(bytes_of(header));
    write(std::as_bytes(std::span(fingerprint)));
    for (const std::span<const std::byte> bytes : state.film.accumulators()) write(bytes);
    const Crc total = crc;
    write(bytes_of(total));
    file.close();
    if (!file) {
      throw Error(ErrorCode::kInternal, path.string(), "cannot be written (disk full or no permission?)");
    }
  });
}

RenderState load_checkpoint(const fs::path& path, const std::string& fingerprint) {
  std::error_code failed;
  const std::uint64_t file_bytes = fs::file_size(path, failed);
  if (failed) throw Error(ErrorCode::kFileNotFound, path.string(), "cannot be read: " + failed.message());
  if (file_bytes < sizeof(Header)) fail_format(path, "is not a checkpoint of voxlume");
  ChecksummedReader reader(path);
  const Header header = reader.read<Header>();
  check_header(header, file_bytes, path);

  std::string found(header.fingerprint_bytes, '\0');
  reader.read(std::as_writable_bytes(std::span(found)));
  RenderState state{Film(static_cast<int>(header.width), static_cast<int>(header.height), layers_of(header)),
                    header.counters, header.elapsed_s, static_cast<int>(header.tile_size)};
  for (const std::span<std::byte> bytes : state.film.accumulators()) reader.read(bytes);
  const Crc computed = reader.crc();
  if (reader.read<Crc>() != computed) fail_format(path, "is a damaged checkpoint: its checksum is wrong");
  if (found != fingerprint) {
    throw Error(ErrorCode::kBadParameter, path.string(),
                "belongs to another scene or other settings; remove it to start again");
  }
  for (const TileRect& tile : make_tiles(state.film.width(), state.film.height(), state.tile_size)) {
    if (!counts_uniform(state.film, tile)) fail_format(path, "is a damaged checkpoint: uneven tiles");
  }
  return state;
}

}  // namespace voxlume
