#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "voxlume/scene.h"

namespace voxlume::cli {

/// The command line's flags that stand for fields of the scene.
class SceneFlags {
 public:
  /// Adds every flag of the table to `command`.
  void add_to(CLI::App& command);
  /// Adds those that say how to read a volume: --raw, --spacing.
  void add_volume_flags_to(CLI::App& command);

  /// Writes what the user gave over `scene`. Throws Error naming the flag.
  void apply(SceneDescription& scene) const;
  /// Whether the user gave this flag ("--aov").
  bool given(const std::string& flag) const;

 private:
  void add(CLI::App& command, std::size_t row);

  struct Given {
    std::size_t row;  ///< of the table
    std::string text;
  };
  std::vector<Given> given_;
  std::vector<std::string> settings_;  ///< of --set
};

/// The scene that INPUT stands for, before flags: a scene file's, or the default one with INPUT as its
/// volume.
SceneDescription scene_of_input(const std::string& input);

/// Calls `work` and puts the scene file's name before the address of an Error about a field
/// ("/transfer/preset").
void with_scene_name(const std::string& input, const std::function<void()>& work);

}  // namespace voxlume::cli
