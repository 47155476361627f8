#include <fmt/format.h>

#include "cli/commands.h"
#include "scene/material_library.h"
#include "scene/presets.h"
#include "scene/scene_schema.h"

namespace voxlume::cli {

void add_presets_command(CLI::App& program, Action& action) {
  CLI::App* const command = program.add_subcommand("presets", "List the transfer function presets");
  command->callback([&action] {
    action = [] {
      for (const Preset& preset : presets()) {
        fmt::print("{:<16} {}\n", preset.name, preset.summary);
      }
      return kDone;
    };
  });
}

void add_materials_command(CLI::App& program, Action& action) {
  CLI::App* const command = program.add_subcommand("materials", "List the materials that rules may name");
  command->callback([&action] {
    action = [] {
      for (const LibraryMaterial& material : material_library())
        fmt::print("{:<16} {}\n", material.description.name, material.summary);
      return kDone;
    };
  });
}

void add_schema_command(CLI::App& program, Action& action) {
  CLI::App* const command = program.add_subcommand("schema", "Print the JSON Schema of scene files");
  const auto markdown = std::make_shared<bool>(false);
  command->add_flag("--markdown", *markdown, "Print the reference of scene files in Markdown instead");
  command->callback([&action, markdown] {
    action = [markdown] {
      fmt::print("{}", *markdown ? scene_reference_markdown() : scene_schema());
      return kDone;
    };
  });
}

}  // namespace voxlume::cli
