#include <gtest/gtest.h>

#include <sys/resource.h>

#include <random>

#include "image_io/image_io.h"
#include "image_io/sample_images.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

// Files as a hostile or failing world makes them: each must give a picture or a clean Error of one line.
class DamagedImage : public testing::TestWithParam<const char*> {
 protected:
  DamagedImage() : name_(std::string("a.") + GetParam()), bytes_(valid_bytes()) {}

  std::string valid_bytes() const {
    const std::string format = GetParam();
    if (format == "hdr") {
      std::mt19937 generator(1);
      std::string rgbe(16 * 8 * 4, '\0');
      for (char& c : rgbe) c = static_cast<char>(3 + generator() % 200);
      return test::hdr_bytes(16, 8, rgbe);
    }
    if (format == "exr") {
      write_exr(test::sample_image(16, 40), folder_ / name_);
    } else {
      std::mt19937 generator(2);
      Image8 image{40, 30, 4, std::vector<std::uint8_t>(4800), {{"voxlume:seed", "1"}}};
      for (std::uint8_t& value : image.values) value = static_cast<std::uint8_t>(generator());
      write_png(image, folder_ / name_);
    }
    return test::read_bytes(folder_ / name_);
  }

  // Whether the bytes read as a picture.
  bool reads(const std::string& bytes) const {
    test::write_bytes(folder_ / name_, bytes);
    try {
      const Image image = read_image(folder_ / name_, {.memory_limit_bytes = 64u << 20});
      EXPECT_EQ(image.rgba.size(), image.pixel_count() * 4);
      return true;
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_FALSE(error.message().empty());
      EXPECT_EQ(what.find_first_of("\n\r\t"), std::string::npos) << what;
      EXPECT_LT(what.size(), 700u) << what;
      return false;
    }
  }

  test::TemporaryFolder folder_;
  std::string name_, bytes_;
};

TEST_P(DamagedImage, WholeFileReads) { EXPECT_TRUE(reads(bytes_)); }

TEST_P(DamagedImage, TruncatedIsRefused) {
  // PNG has 12 bytes (IEND) and EXR none after the last pixel.
  const std::size_t spare = std::string(GetParam()) == "png" ? 12 : 0;
  const std::size_t end = bytes_.size() - spare;
  for (int i = 0; i < 60; ++i) {
    const std::size_t length = i < 20 ? end - 1 - static_cast<std::size_t>(i) * 3 : end * (i - 20) / 40;
    EXPECT_FALSE(reads(bytes_.substr(0, length))) << length << " of " << bytes_.size();
  }
}

TEST_P(DamagedImage, FlippedBitsAreSurvived) {
  std::mt19937 generator(3);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string damaged = bytes_;
    for (int flips = 1 + i % 4; flips > 0; --flips) {
      const std::size_t range = i % 2 == 0 ? std::min<std::size_t>(400, damaged.size()) : damaged.size();
      const std::size_t at = generator() % range;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << generator() % 8));
    }
    refused += reads(damaged) ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

TEST_P(DamagedImage, ExtremeHeaderWordsAreSurvived) {
  for (std::size_t at = 4; at + 4 < std::min<std::size_t>(bytes_.size(), 420); ++at) {
    for (const char* word : {"\xff\xff\xff\x7f", "\xff\xff\xff\xff"}) {
      std::string damaged = bytes_;
      damaged.replace(at, 4, word, 4);
      reads(damaged);
    }
    std::string zeroed = bytes_;
    zeroed.replace(at, 4, 4, '\0');
    reads(zeroed);
  }
}

TEST_P(DamagedImage, GarbageAfterTheMagicIsRefused) {
  std::mt19937 generator(4);
  for (int i = 0; i < 50; ++i) {
    std::string garbage(generator() % 3000, '\0');
    for (char& c : garbage) c = static_cast<char>(generator());
    EXPECT_FALSE(reads(garbage));
    EXPECT_FALSE(reads(bytes_.substr(0, 8) + garbage));
  }
}

TEST_P(DamagedImage, MissingMiddleIsSurvived) {
  std::mt19937 generator(5);
  for (int i = 0; i < 60; ++i) {
    const std::size_t at = generator() % bytes_.size();
    std::string damaged = bytes_;
    damaged.erase(at, 1 + generator() % 64);
    reads(damaged);
  }
}

TEST_P(DamagedImage, MemoryStaysBounded) {
  // Runs after the others in this program: no header has made the process large.
  rusage usage{};
  ASSERT_EQ(getrusage(RUSAGE_SELF, &usage), 0);
  EXPECT_LT(usage.ru_maxrss, 700 * 1024) << "KiB";
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedImage, testing::Values("exr", "hdr", "png"),
                         [](const auto& format) { return std::string(format.param); });

}  // namespace
}  // namespace voxlume
