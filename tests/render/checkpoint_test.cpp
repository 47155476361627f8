#include "render/checkpoint.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <random>

#include "render/synthetic_trace.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr char kScene[] = "{\"scene\": 1}";

class Checkpoint : public testing::Test {
 protected:
  Checkpoint() : state_(test::direct_state(13, 9, 6)) {
    state_.tile_size = 4;
    state_.elapsed_s = 0.1 + 0.2;
    save_checkpoint(state_, kScene, path());
    bytes_ = test::read_bytes(path());
  }

  std::filesystem::path path() const { return folder_ / "out.exr.checkpoint"; }

  // The error of loading these bytes; nothing when they load.
  std::optional<Error> error_of(std::string_view bytes) const {
    test::write_bytes(path(), bytes);
    try {
      load_checkpoint(path(), kScene);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error;
    }
    return std::nullopt;
  }

  ErrorCode code_of(std::string_view bytes) const {
    const std::optional<Error> error = error_of(bytes);
    EXPECT_TRUE(error.has_value()) << "it loads";
    return error ? error->code() : ErrorCode::kInternal;
  }

  // The bytes with a field overwritten and the checksum made right again.
  template <class T>
  std::string with_field(std::size_t offset, T value) const {
    std::string changed = bytes_;
    std::memcpy(changed.data() + offset, &value, sizeof(value));
    const std::size_t body = changed.size() - 4;
    const auto* start = reinterpret_cast<const Bytef*>(changed.data());
    const auto crc = static_cast<std::uint32_t>(crc32(0, start, static_cast<uInt>(body)));
    std::memcpy(changed.data() + body, &crc, sizeof(crc));
    return changed;
  }

  test::TemporaryFolder folder_;
  RenderState state_;
  std::string bytes_;
};

TEST_F(Checkpoint, RoundTripIsExact) {
  const RenderState loaded = load_checkpoint(path(), kScene);
  EXPECT_EQ(test::film_bytes(loaded.film), test::film_bytes(state_.film));
  EXPECT_EQ(loaded.film.layers(), state_.film.layers());
  EXPECT_EQ(loaded.counters, state_.counters);
  EXPECT_EQ(loaded.elapsed_s, state_.elapsed_s);
  EXPECT_EQ(loaded.tile_size, 4);
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST_F(Checkpoint, FilmWithoutLayers) {
  RenderState plain{.film = Film(3, 2), .counters = {}, .elapsed_s = 0, .tile_size = 32};
  plain.film.add(1, 1, {.radiance = {1, 2, 3}});
  plain.tile_size = 1;
  save_checkpoint(plain, "", path());
  EXPECT_EQ(test::film_bytes(load_checkpoint(path(), "").film), test::film_bytes(plain.film));

  std::string damaged = test::read_bytes(path());
  damaged[sizeof(std::uint64_t) * 3] ^= 2;  // the tile size: still possible, but not what was written
  EXPECT_EQ(code_of(damaged), ErrorCode::kBadFormat);
}

TEST_F(Checkpoint, LiesBesideThePicture) {
  EXPECT_EQ(checkpoint_path("/a/b/out.exr"), "/a/b/out.exr.checkpoint");
}

TEST_F(Checkpoint, AnotherSceneIsRefused) {
  try {
    load_checkpoint(path(), "another");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
  }
}

TEST_F(Checkpoint, MissingFile) {
  EXPECT_THROW(load_checkpoint(folder_ / "none", kScene), Error);
  EXPECT_THROW(load_checkpoint(folder_.path(), kScene), Error);
}

TEST_F(Checkpoint, TruncatedAnywhere) {
  for (std::size_t length = 0; length < bytes_.size(); length += length < 200 ? 1 : 97) {
    EXPECT_EQ(code_of(bytes_.substr(0, length)), ErrorCode::kBadFormat) << length;
  }
  EXPECT_EQ(code_of(bytes_.substr(0, bytes_.size() - 1)), ErrorCode::kBadFormat);
  EXPECT_EQ(code_of(bytes_ + "x"), ErrorCode::kBadFormat);
}

TEST_F(Checkpoint, FlippedBits) {
  std::mt19937 generator(3);
  for (int i = 0; i < 600; ++i) {
    std::string damaged = bytes_;
    const std::size_t at = i < 104 ? static_cast<std::size_t>(i) : generator() % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << generator() % 8));
    EXPECT_EQ(code_of(damaged), ErrorCode::kBadFormat) << at;
  }
}

TEST_F(Checkpoint, Garbage) {
  std::mt19937 generator(4);
  for (int i = 0; i < 40; ++i) {
    std::string garbage(generator() % 5000, '\0');
    for (char& c : garbage) c = static_cast<char>(generator());
    EXPECT_EQ(code_of(garbage), ErrorCode::kBadFormat);
    // With the beginning of a checkpoint.
    std::copy_n(bytes_.begin(), std::min<std::size_t>(garbage.size(), 16), garbage.begin());
    EXPECT_EQ(code_of(garbage), ErrorCode::kBadFormat);
  }
}

TEST_F(Checkpoint, RightChecksumWrongContent) {
  EXPECT_FALSE(error_of(with_field<std::uint32_t>(8, 2)).has_value());  // format version, unchanged
  const std::optional<Error> version = error_of(with_field<std::uint32_t>(8, 1));
  ASSERT_TRUE(version.has_value());
  EXPECT_NE(version->message().find("format 1; expected 2"), std::string::npos) << version->what();
  for (const std::size_t offset : {12, 16, 20, 24, 28}) {  // byte order, width, height, tile size, layers
    for (const std::uint32_t value : {0u, 65537u, 0x7fffffffu, 0xffffffffu}) {
      if (offset == 28 && value == 0) continue;
      EXPECT_EQ(code_of(with_field(offset, value)), ErrorCode::kBadFormat) << offset << " " << value;
    }
  }
  for (const std::uint64_t value : {~std::uint64_t{0}, std::uint64_t{1} << 40, std::uint64_t{0}}) {
    EXPECT_EQ(code_of(with_field(32, value)), ErrorCode::kBadFormat) << value;
  }
  // A pixel with a count of its own: the first of the counts, after header, fingerprint and sums.
  const std::size_t counts = 88 + (sizeof(kScene) - 1) + 13 * 9 * 56;
  EXPECT_EQ(code_of(with_field<std::uint32_t>(counts, 7)), ErrorCode::kBadFormat);
}

}  // namespace
}  // namespace voxlume
