#pragma once
#include <memory>
#include <optional>
#include <string>

#include "accel/accelerator.h"
#include "grid/volume_statistics.h"
#include "integrator/scene_view.h"
#include "light/compile_lights.h"
#include "scene/labels.h"
#include "transfer/transfer_function.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// The structure that a scene asks for. Throws Error kBadParameter for words it does not know.
AcceleratorChoice accelerator_choice(const RenderDescription& render, const GridView& grid);

/// A scene ready to trace: owns the voxels and every table that view() points to. Immutable. World
/// coordinates of view() are LPS mm from the volume's centre.
class CompiledScene {
 public:
  /// `description` is resolved (scene/resolve.h); reads its environment picture and label volume.
  /// Throws Error with the scene path or file of what is wrong; kUnsupported for a choice that is not built.
  CompiledScene(SceneDescription description, Volume volume, const VolumeStatistics& statistics);
  CompiledScene(const CompiledScene&) = delete;
  CompiledScene& operator=(const CompiledScene&) = delete;

  const SceneView& view() const { return view_; }
  const SceneDescription& description() const { return description_; }
  const Volume& volume() const { return volume_; }
  const std::optional<LabelTable>& label_table() const { return label_table_; }
  /// What reading the scene's other files had to say.
  const std::vector<std::string>& warnings() const { return warnings_; }

  double majorant_build_ms() const { return majorant_build_ms_; }

 private:
  void check_values(const VolumeStatistics& statistics);
  void compile_medium(const SceneDescription& local);
  void compile_scattering(const VolumeStatistics& statistics);
  void compile_labels();
  void compile_lights_and_camera(const SceneDescription& local);
  void compile_image();

  SceneDescription description_;
  Volume volume_;
  Double3 origin_mm_;  ///< LPS place of the kernels' origin: the volume's centre
  std::optional<Volume> label_volume_;
  std::optional<LabelTable> label_table_;
  std::vector<std::string> warnings_;
  TransferFunction transfer_;
  Accelerator accelerator_;
  std::optional<Lights> lights_;
  double majorant_build_ms_ = 0;
  SceneView view_;
};

}  // namespace voxlume
