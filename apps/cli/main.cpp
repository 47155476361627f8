#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <new>

#include "cli/commands.h"
#include "scene/field_info.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

constexpr const char* kExamples = R"(
Examples:
  voxlume render head-ct.nrrd -o head.png --preset ct-bone --size 800x600 --spp 128
  voxlume render dicom-folder -o head.exr --camera 30,10 --aov depth,albedo --stats head.json
  voxlume render scene.json -o out.png --exposure 1 --save-scene changed.json
  voxlume info head-ct.nrrd
  voxlume view head-ct.nrrd
  voxlume convert dicom-folder head.nrrd
  voxlume denoise frame-####.exr -o clean-####.exr
  voxlume compare a.exr b.exr --json

INPUT is a volume file (NRRD, MetaImage, NIfTI, TIFF, VTK, HDF5, OpenVDB, or raw with --raw), a folder with
a DICOM series or TIFF slices, a scene (.json), or "phantom", a built-in head.

Exit codes: 0 done; 2 bad usage or input; 1 any other failure; 130 interrupted.)";

int report(int code, const std::string& message) {
  std::string line = message;
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  fmt::print(stderr, "error: {}\n", line);
  return code;
}

int exit_code(const Error& error) { return error.code() == ErrorCode::kInternal ? kFailed : kBadUsage; }

/// The command the user chose so far, else the program.
const CLI::App& chosen(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? program : *commands.front();
}

/// The first argument that nobody took, with the nearest known one.
std::string unknown_argument(const CLI::App& program) {
  const CLI::App& command = chosen(program);
  const auto extras = program.remaining(true);
  const std::string extra = extras.empty() ? "" : extras.front();
  std::vector<std::string> names;
  if (extra.starts_with("-")) {
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  } else if (&command == &program) {
    for (const CLI::App* sub : program.get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(sub->get_name());
    }
  }
  const std::string word = extra.substr(0, extra.find('='));
  const std::string near = nearest_word(word, {names.begin(), names.end()});
  const char* const kind = &command == &program && !extra.starts_with("-") ? "command" : "argument";
  std::string message = fmt::format("unknown {} {}", kind, quote_text(word));
  if (!near.empty()) return message + fmt::format("; did you mean {}?", near);
  return message +
         fmt::format("; see voxlume {}--help", &command == &program ? "" : command.get_name() + " ");
}

/// The parser's "--spp: 1 required N missing" and "--spp: At Most 1 required but received 2" in plain words.
std::string count_message(const std::string& text) {
  const std::string flag = text.substr(0, text.find(": "));
  return flag + (text.ends_with("missing") ? ": its value is missing" : ": given more than once");
}

/// A descriptor from 0 to 2 that is closed would be given to the next file opened, and messages written into
/// it.
void open_standard_streams() {
  for (int stream = 0; stream <= 2; ++stream) {
    if (::fcntl(stream, F_GETFD) == -1) ::open("/dev/null", O_RDWR);
  }
}

int run(int argc, char** argv) {
  CLI::App program{"voxlume: photorealistic pictures of scientific and medical volumes", "voxlume"};
  program.set_version_flag("--version", "voxlume " VOXLUME_VERSION);
  program.footer(kExamples);
  Action action;
  add_render_command(program, action);
  add_info_command(program, action);
  add_convert_command(program, action);
  add_denoise_command(program, action);
  add_compare_command(program, action);
  add_presets_command(program, action);
  add_materials_command(program, action);
  add_schema_command(program, action);
  add_view_command(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return program.exit(help_or_version);
  } catch (const CLI::ExtrasError&) {
    return report(kBadUsage, unknown_argument(program));
  } catch (const CLI::ArgumentMismatch& error) {
    return report(kBadUsage, count_message(error.what()));
  } catch (const CLI::ParseError& error) {
    return report(kBadUsage, error.what());
  }
  if (!action)
    return report(
        kBadUsage,
        "no command; expected one of render, view, info, convert, denoise, compare, presets, materials, "
        "schema (see voxlume --help)");
  return action();
}

}  // namespace
}  // namespace voxlume::cli

int main(int argc, char** argv) {
  using namespace voxlume;
  cli::open_standard_streams();
  try {
    const int code = cli::run(argc, argv);
    if (std::fflush(stdout) != 0) return cli::report(cli::kFailed, "standard output cannot be written");
    return code;
  } catch (const Error& error) {
    return cli::report(cli::exit_code(error), error.what());
  } catch (const std::bad_alloc&) {
    return cli::report(cli::kFailed, "out of memory");
  } catch (const std::exception& error) {
    return cli::report(cli::kFailed, error.what());
  }
}
