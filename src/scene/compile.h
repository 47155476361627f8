#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accel/accelerator.h"
#include "grid/value_range.h"
#include "grid/volume_statistics.h"
#include "integrator/environment_guide.h"
#include "integrator/scene_view.h"
#include "integrator/virtual_lights.h"
#include "integrator/visibility.h"
#include "light/compile_lights.h"
#include "scene/labels.h"
#include "scene/materials.h"
#include "scene/rule_volumes.h"
#include "transfer/extinction_color.h"
#include "transfer/transfer_function.h"
#include "visibility/importance_field.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// A scene ready to trace: owns the voxels and every table that view() points to. World coordinates of view()
/// are LPS mm from the volume's centre.
class CompiledScene {
 public:
  /// `description` is resolved (scene/resolve.h); reads its environment picture and label volume.
  /// Throws Error with the scene path or file of what is wrong; kUnsupported for a choice that is not built.
  /// `progress`, which may be empty, hears of what takes long: proxies, and the lists of what is important;
  /// it ends them by throwing.
  CompiledScene(SceneDescription description, Volume volume, const VolumeStatistics& statistics,
                const ListProgress& progress = {});
  CompiledScene(const CompiledScene&) = delete;
  CompiledScene& operator=(const CompiledScene&) = delete;

  /// Compiles another description of the same volume, and of it only what differs: a camera, lights or a clip
  /// box take microseconds, a transfer function the majorants that it changes; value ranges are built again
  /// for another accelerator only, and the environment's picture is read again where the environment changes
  /// and its path or file time does. `description` is resolved; its volume counts as the one at hand. Nothing
  /// may be tracing, and copies of view() are out of date afterwards. Throws as the constructor does; the
  /// scene is then what it was. Where `progress` has thrown, the scene may be the new one
  /// without its lists: it must not be traced before it is updated again, to any scene.
  void update(SceneDescription description, const ListProgress& progress = {});

  const SceneView& view() const { return view_; }
  const SceneDescription& description() const { return description_; }
  const Volume& volume() const { return volume_; }
  /// The place of view()'s origin [LPS mm].
  const Double3& origin_mm() const { return origin_mm_; }
  const std::optional<LabelTable>& label_table() const { return label_table_; }
  /// What of it may not be as whoever wrote it expects, a line each: what reading its other files had to say,
  /// values that cannot be shown, and when nothing is visible.
  std::vector<std::string> warnings() const;

  /// Of the last compilation that changed the transfer function or the accelerator.
  double majorant_build_ms() const { return majorant_build_ms_; }
  /// What the last compilation spent on the lists of what is important; 0 where it kept them.
  double importance_list_s() const { return importance_list_s_; }
  std::size_t importance_list_bytes() const { return pixel_lists_ ? pixel_lists_->bytes() : 0; }

 private:
  struct Parts;

  void compile(SceneDescription description, bool everything, const ListProgress& progress);
  void compile_rules(const SceneDescription& description, bool everything, Parts& parts,
                     const Progress& progress) const;
  float max_mu_t() const;
  Parts compile_parts(const SceneDescription& description, bool everything, const Progress& progress) const;
  void compile_lights(const SceneDescription& local, bool everything, const CameraView& camera,
                      const SceneSphere& sphere);
  void put_medium(Parts& parts, const SceneDescription& local);
  void put_scattering(Parts& parts, const SceneDescription& description);
  void put_illustration(const SceneDescription& description);
  void put_image(const SceneDescription& description);
  static std::optional<ImportanceField> compile_importance(const SceneDescription& local,
                                                           std::span<const RuleVolume> volumes, bool same);
  void put_visibility(std::optional<ImportanceField> importance, const SceneDescription& local,
                      bool same_lists, const ListProgress& progress);
  void put_integrator(const SceneDescription& local, const SceneSphere& sphere, bool same_light);

  SceneDescription description_;
  Volume volume_;
  Double3 origin_mm_;            ///< the volume's centre
  VolumeStatistics statistics_;  ///< without the histogram
  std::optional<Volume> label_volume_;
  std::optional<LabelTable> label_table_;
  std::optional<TransferFunction> transfer_;
  std::optional<ExtinctionColorCurve> extinction_color_;
  std::optional<RuleVolumes> rule_volumes_;
  std::optional<Materials> materials_;
  std::optional<Classifier> classifier_;
  std::optional<Accelerator> accelerator_;
  std::optional<Lights> lights_;
  std::filesystem::file_time_type environment_time_{};  ///< of the environment's picture, when it was read
  std::optional<TransferFunction> ramp_;                ///< of an illustration
  std::optional<ImportanceField> importance_;
  std::optional<PixelLists> pixel_lists_;
  std::optional<EnvironmentGuide> environment_guide_;
  std::optional<VirtualLights> virtual_lights_;
  double majorant_build_ms_ = 0;
  double importance_list_s_ = 0;
  SceneView view_;
};

}  // namespace voxlume
