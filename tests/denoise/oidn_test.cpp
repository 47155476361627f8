#include "denoise/oidn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "denoise/test_frame.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

/// Sets VOXLUME_OIDN_LIBRARY while it lives.
class LibraryVariable {
 public:
  explicit LibraryVariable(const char* value) {
    if (const char* set = std::getenv(kName)) before_ = set;
    setenv(kName, value, 1);
  }
  ~LibraryVariable() { before_.empty() ? unsetenv(kName) : setenv(kName, before_.c_str(), 1); }

 private:
  static constexpr const char* kName = "VOXLUME_OIDN_LIBRARY";
  std::string before_;
};

std::string refusal() {
  try {
    make_oidn();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kUnsupported);
    return e.what();
  }
  ADD_FAILURE() << "was not refused";
  return {};
}

TEST(Oidn, NamesTheVariableOfALibraryThatIsNotThere) {
  const LibraryVariable variable("/no/such/libOpenImageDenoise.so");
  const std::string message = refusal();
  EXPECT_THAT(message, testing::HasSubstr("VOXLUME_OIDN_LIBRARY"));
  EXPECT_THAT(message, testing::HasSubstr("/no/such/libOpenImageDenoise.so"));
}

TEST(Oidn, RefusesALibraryThatIsSomethingElse) {
  const LibraryVariable variable("libm.so.6");
  const std::string message = refusal();
  EXPECT_THAT(message, testing::HasSubstr("oidnNewDevice"));
  EXPECT_THAT(message, testing::HasSubstr("VOXLUME_OIDN_LIBRARY"));
  EXPECT_THAT(message, testing::HasSubstr("\"libm.so.6\""));
}

TEST(Oidn, DenoisesATexturedSurface) {
  std::unique_ptr<Denoiser> denoiser;
  try {
    denoiser = make_oidn();
  } catch (const Error& e) {
    GTEST_SKIP() << e.what();
  }
  const auto checkered = [](int x, int y) {
    const bool light = ((x / 8) + (y / 8)) % 2 != 0;
    return TestPixel{.radiance = Vec3f(light ? 0.6f : 0.2f), .albedo = Vec3f(light ? 0.9f : 0.3f)};
  };
  const DenoiseFrame noisy = test_frame(96, 64, checkered, 0.7, 2);
  const Planes3 exact = test_frame(96, 64, checkered).radiance;
  DenoisedFrame out;
  denoiser->denoise(noisy, out);
  EXPECT_LT(difference(out.radiance, exact), difference(noisy.radiance, exact) / 4);
}

}  // namespace
}  // namespace voxlume
