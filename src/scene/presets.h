#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "grid/volume_statistics.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// A named transfer function. Those for CT are written in HU; the others take their data values from the
/// volume.
struct Preset {
  std::string_view name;
  std::string_view summary;  ///< one line for `voxlume presets`
  std::vector<TransferPoint> (*points)(const VolumeStatistics&);
};

/// Every preset, in the order in which they are listed.
const std::vector<Preset>& presets();

/// Throws Error kBadParameter, naming the nearest preset, when there is none of that name.
const Preset& find_preset(std::string_view name);

/// The preset used when none is named: ct-bone for data in HU, mri-head for MR and NIfTI, else generic.
const Preset& automatic_preset(const Volume& volume, const VolumeStatistics& statistics);

/// Whether the data is in Hounsfield units: its file says CT, or it says nothing and has air near -1000.
bool is_hounsfield(const Volume& volume, const VolumeStatistics& statistics);

/// The longest of the volume's sides, its outermost voxels whole.
double longest_side_mm(const Volume& volume);

/// The reference length opacities are drawn for when none is given [mm]: 1 for CT, else 1/256 of the volume's
/// longest side.
double default_reference_length_mm(const Volume& volume, const VolumeStatistics& statistics);

/// Otsu's threshold between background and matter: maximises the between-class variance of the histogram.
double otsu_threshold(const VolumeStatistics& statistics);

}  // namespace voxlume
