#include "image_io/picture_text.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "image_io/image_io.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

TEST(PictureText, IsFoundInPicturesOfOurs) {
  const fs::path folder = fs::temp_directory_path() / ("voxlume-text-" + std::to_string(::getpid()));
  fs::create_directory(folder);
  const std::map<std::string, std::string> metadata{{"voxlume:digest", "0123abcd"},
                                                    {"voxlume:scene", std::string(100000, 'x')}};
  Image image(3, 2);
  image.metadata = metadata;
  write_exr(image, folder / "a.exr");
  Image8 encoded{3, 2, 3, std::vector<std::uint8_t>(18), metadata};
  write_png(encoded, folder / "a.png");
  for (const char* name : {"a.exr", "a.png"}) {
    EXPECT_EQ(picture_text(folder / name, "voxlume:digest"), "0123abcd") << name;
    EXPECT_EQ(picture_text(folder / name, "voxlume:scene").size(), 100000u) << name;
    EXPECT_EQ(picture_text(folder / name, "voxlume:dig"), "") << name;
    // Cut anywhere, there is the text or none.
    for (const std::uintmax_t bytes : {3u, 9u, 40u, 200u, 100100u}) {
      fs::copy_file(folder / name, folder / "cut", fs::copy_options::overwrite_existing);
      if (bytes < fs::file_size(folder / "cut")) fs::resize_file(folder / "cut", bytes);
      const std::string text = picture_text(folder / "cut", "voxlume:digest");
      EXPECT_TRUE(text.empty() || text == "0123abcd") << name << " of " << bytes;
    }
  }
  std::ofstream(folder / "other") << "text";
  EXPECT_EQ(picture_text(folder / "other", "voxlume:digest"), "");
  EXPECT_THROW(picture_text(folder / "none", "voxlume:digest"), Error);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace voxlume
