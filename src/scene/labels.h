#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "base/vec.h"

namespace voxlume {

/// A name and a colour per label value; index = label value.
struct LabelTable {
  std::vector<std::string> names;  ///< empty where a label has no name
  std::vector<Vec3f> colors;       ///< linear Rec. 709; x < 0 where a label has no colour. As long as `names`
};

/// The files beside a label volume that its names and colours are read from, where no other file is named for
/// them: VOLUME.lut and VOLUME.txt, or the volume's name with its endings replaced by these. One of each
/// ending at most, the colours first.
std::vector<std::filesystem::path> label_files_beside(const std::filesystem::path& volume_path);

/// Reads names and colours of `count` labels (values 0 .. count-1; 0 is background and stays without colour).
/// `names_path` is a text file of "value name [r g b [a]]" lines (colours 0..255 sRGB, # comments), or a .lut
/// of 256 red, 256 green and 256 blue bytes; empty: label_files_beside(volume_path). Labels that have no
/// colour (in a .lut: or black) get one of evenly spread hues. Throws Error kFileNotFound for a names_path
/// that is not there, kBadFormat with the line of what cannot be read.
LabelTable read_label_table(const std::filesystem::path& volume_path, const std::filesystem::path& names_path,
                            std::size_t count);

}  // namespace voxlume
