#include "scene/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.h"
#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

class Labels : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
  }
  std::filesystem::path at(const std::string& name) const { return folder_.path() / name; }

  test::TemporaryFolder folder_;
};

TEST_F(Labels, NamesAndColoursFromText) {
  write("names.txt", "# a comment\n\n1 Bone 255 128 0\n2 Skin\n3 Precentral_L 2001\n900 beyond\n");
  const LabelTable table = read_label_table(at("x.nii.gz"), at("names.txt"), 5);
  EXPECT_EQ(table.names, (std::vector<std::string>{"", "Bone", "Skin", "Precentral_L", ""}));
  EXPECT_FLOAT_EQ(table.colors[1].x, 1);
  EXPECT_FLOAT_EQ(table.colors[1].y, linear_from_srgb(128 / 255.0f));
  EXPECT_LT(table.colors[0].x, 0) << "background has no colour";
  for (int label = 2; label < 5; ++label) {
    EXPECT_GE(min_component(table.colors[label]), 0) << label;
    EXPECT_GT(max_component(table.colors[label]), 0.1f) << label << " would be black";
  }
  EXPECT_NE(table.colors[2], table.colors[3]);
}

TEST_F(Labels, ColoursFromATableWithBlackForNone) {
  std::string lut(768, '\0');
  lut[2] = '\xff';
  lut[512 + 2] = '\x80';
  write("atlas.lut", lut);
  const LabelTable table = read_label_table(at("x.nii.gz"), at("atlas.lut"), 4);
  EXPECT_FLOAT_EQ(table.colors[2].x, 1);
  EXPECT_FLOAT_EQ(table.colors[2].y, 0);
  EXPECT_FLOAT_EQ(table.colors[2].z, linear_from_srgb(128 / 255.0f));
  EXPECT_GT(max_component(table.colors[3]), 0.1f);
}

TEST_F(Labels, FilesBesideTheVolumeAreFound) {
  std::string lut(768, '\0');
  lut[1] = '\xff';
  write("aal.nii.lut", lut);
  write("aal.nii.txt", "1 First\n");
  const LabelTable table = read_label_table(at("aal.nii.gz"), {}, 2);
  EXPECT_EQ(table.names[1], "First");
  EXPECT_FLOAT_EQ(table.colors[1].x, 1);
  EXPECT_EQ(read_label_table(at("other.nii.gz"), {}, 2).names[1], "");
}

TEST_F(Labels, DamagedFilesAreRefused) {
  write("short.lut", std::string(700, 'x'));
  write("long.lut", std::string(769, 'x'));
  write("words.txt", "one Bone\n");
  write("minus.txt", "-4 Bone\n");
  write("huge.txt", "99999999999999999999 Bone\n");
  write("colours.txt", "1 Bone 300 0 0\n");
  for (const char* name : {"short.lut", "long.lut", "words.txt", "minus.txt", "huge.txt", "colours.txt"}) {
    try {
      read_label_table(at("x.nii.gz"), at(name), 5);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadFormat) << name;
      EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
      EXPECT_THAT(error.what(), testing::HasSubstr(name));
    }
  }
  EXPECT_THROW(read_label_table(at("x.nii.gz"), at("absent.txt"), 5), Error);
}

}  // namespace
}  // namespace voxlume
