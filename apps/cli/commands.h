#pragma once
#include <CLI/CLI.hpp>
#include <functional>

namespace voxlume::cli {

/// Exit codes scripts rely on.
enum ExitCode { kDone = 0, kFailed = 1, kBadUsage = 2, kInterrupted = 130 };

/// What the chosen command does after the command line is understood; returns an exit code. Throws
/// voxlume::Error.
using Action = std::function<int()>;

// Each adds its command to the program, and sets `action` when the user chooses it.
void add_render_command(CLI::App& program, Action& action);
void add_info_command(CLI::App& program, Action& action);
void add_convert_command(CLI::App& program, Action& action);
void add_denoise_command(CLI::App& program, Action& action);
void add_compare_command(CLI::App& program, Action& action);
void add_presets_command(CLI::App& program, Action& action);
void add_materials_command(CLI::App& program, Action& action);
void add_schema_command(CLI::App& program, Action& action);
void add_view_command(CLI::App& program, Action& action);

}  // namespace voxlume::cli
