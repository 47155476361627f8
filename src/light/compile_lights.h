#pragma once
#include <vector>

#include "light/lights_view.h"
#include "light/view_frame.h"
#include "sampling/distribution.h"
#include "voxlume/image.h"
#include "voxlume/scene.h"

namespace voxlume {

/// What lights illuminate.
struct SceneSphere {
  Vec3f center_mm{0, 0, 0};
  float radius_mm = 1;  ///< > 0
};

/// What of the environment light samples are drawn for. kExcess: only what is above its mean; directions that
/// matter scatters to find the rest, a constant environment altogether, and lights that are hard to find get
/// the samples ("MIS compensation", Karlik et al. 2019). Complete only together with such directions.
/// kUniform: all directions alike, and all lights alike, as Exposure Render has it.
enum class EnvironmentSamples { kWhole, kExcess, kUniform };

/// The lights of a scene, validated and in LPS space. Owns the tables behind view().
///
/// The environment's own axes are those of the world (x left, y posterior, z head), or of the camera (right,
/// forward, up); the picture's centre is along +y, so that unrotated it lies behind the volume in the default
/// view, and its right half is on +x. rotation_deg turns it about +z as the azimuth turns the eye: what was
/// at -y moves toward +x.
///
/// A light is picked with probability 0.9 * its share of the luminance of the irradiance at the sphere's
/// centre (nearer lights counted as if on the sphere; the environment as pi * mean radiance of what is
/// sampled) + 0.1 / n, n lights emitting.
class Lights {
 public:
  /// `image` may be null; it is multiplied by the environment's colour and intensity, and values below 0
  /// count as 0. Throws kBadParameter at "/lights/I/..." or "/environment/..." for missing, non-finite or
  /// out-of-range values.
  Lights(const std::vector<LightDescription>& lights, const EnvironmentDescription& environment,
         const EnvironmentImage* image, const ViewFrame& camera, const SceneSphere& scene,
         EnvironmentSamples samples = EnvironmentSamples::kWhole);

  /// Other lights, another camera, scene and environment, which keeps the picture that it has. Throws as the
  /// constructor does, and nothing has changed then.
  void update(const std::vector<LightDescription>& lights, const EnvironmentDescription& environment,
              const ViewFrame& camera, const SceneSphere& scene, EnvironmentSamples samples);

  /// Valid while this lives, also after a move, until update().
  LightsView view() const;

 private:
  void take_image(const EnvironmentImage& image);
  void compile_environment(Vec3f scale, EnvironmentSamples samples);
  void turn_environment(const EnvironmentDescription& description, const ViewFrame& camera);
  Vec3f mean_radiance(Vec3f scale) const;
  void compile_choice();
  void compile_pick(const SceneSphere& scene);

  std::vector<Light> lights_;
  int rect_count_ = 0;
  bool has_environment_ = false;
  EnvironmentView environment_;  // the pointers are filled in by view()
  std::vector<Vec3f> texels_;
  std::vector<float> cap_versine_;
  Distribution2D texel_choice_;
  Distribution1D pick_;
  Vec3f mean_environment_{0, 0, 0};
  double sampled_environment_ = 0;  ///< mean luminance of what light samples are drawn for
  EnvironmentSamples samples_ = EnvironmentSamples::kWhole;
};

}  // namespace voxlume
