#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "run_voxlume.h"

namespace voxlume::test {

/// A folder of its own for every test, holding ball.nrrd (a ball of value 1000 in air, int16, 16^3 voxels of
/// 1 x 1 x 1.5 mm) and ball.raw (the same voxels without header).
class CliTest : public testing::Test {
 protected:
  static constexpr int kEdge = 16;

  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::vector<std::int16_t> voxels;
    for (int k = 0; k < kEdge; ++k) {
      for (int j = 0; j < kEdge; ++j) {
        for (int i = 0; i < kEdge; ++i) {
          const double r = std::hypot(i - 7.5, j - 7.5, k - 7.5);
          voxels.push_back(static_cast<std::int16_t>(r < 5 ? 1000 : r < 6 ? 200 : -1000));
        }
      }
    }
    const std::string bytes(reinterpret_cast<const char*>(voxels.data()), voxels.size() * 2);
    write("ball.raw", bytes);
    write("ball.nrrd",
          "NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 16 16 16\n"
          "space directions: (1,0,0) (0,1,0) (0,0,1.5)\nspace origin: (-7.5,-7.5,-11.25)\nkinds: domain "
          "domain domain\n"
          "endian: little\nencoding: raw\n\n" +
              bytes);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  std::string read(const std::string& name) const { return file_text(folder_ / name); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  RunResult run(const std::vector<std::string>& arguments) const { return run_voxlume(arguments, folder_); }
  /// `render INPUT -o OUT` at a size and sample count that take no time, then `more`.
  RunResult render(const std::string& input, const std::string& out,
                   const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"render", input, "-o", out, "--size", "24x20", "--spp", "4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  const std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                        ("voxlume-cli-" + std::to_string(::getpid()) + "-" +
                                         testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace voxlume::test
