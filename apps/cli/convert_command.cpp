#include <filesystem>

#include "base/file_extension.h"
#include "cli/commands.h"
#include "cli/output_file.h"
#include "cli/scene_flags.h"
#include "cli/terminal.h"
#include "image_io/image_io.h"
#include "render/file_denoiser.h"
#include "scene/open_volume.h"
#include "voxlume/volume_io.h"

namespace voxlume::cli {
namespace {

struct ConvertRequest {
  std::string input, output;
  SceneFlags flags;
};

/// Whether a name is that of a picture of linear values.
bool is_picture(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".exr" || extension == ".hdr";
}

int develop(const ConvertRequest& request) {
  picture_format(request.output, "OUTPUT");
  check_writable(request.output, "OUTPUT");
  check_not_input(request.output, {request.input}, "OUTPUT");
  save_with_own_scene(read_image(request.input), request.input, request.output);
  return kDone;
}

int convert(const ConvertRequest& request) {
  if (is_picture(request.input)) return develop(request);
  SceneDescription scene = scene_of_input(request.input);
  request.flags.apply(scene);
  const std::filesystem::path output = request.output;
  if (output.has_filename() && !std::filesystem::is_directory(output)) check_writable(output, "OUTPUT");
  check_not_input(output, {request.input, scene.volume.path}, "OUTPUT");
  ProgressLine progress;
  progress.show("reading " + request.input);
  Volume volume;
  with_scene_name(request.input,
                  [&] { volume = open_volume(scene.volume, progress.of("reading " + request.input)); });
  progress.clear();
  print_warnings(volume.warnings);
  progress.show("writing " + request.output);
  write_volume(volume, request.output);
  return kDone;
}

}  // namespace

void add_convert_command(CLI::App& program, Action& action) {
  CLI::App* const command =
      program.add_subcommand("convert", "Write a volume in another format, or develop a picture");
  const auto request = std::make_shared<ConvertRequest>();
  command
      ->add_option("INPUT", request->input,
                   "Volume file, DICOM folder, scene (.json) or \"phantom\"; or a picture, .exr or .hdr")
      ->required();
  command
      ->add_option(
          "OUTPUT", request->output,
          "By extension: .nrrd .nhdr .mha .mhd .nii .nii.gz .tif .vtk .h5 .vdb; FOLDER/ gets a DICOM series. "
          "Of a picture .png, developed with the exposure and tone curve of its scene, or .exr")
      ->required();
  request->flags.add_volume_flags_to(*command);
  command->footer(
      "\nExamples:\n  voxlume convert dicom-folder head.nrrd\n"
      "  voxlume convert block.bin block.nii.gz --raw 64x64x64,u8,1,1,1\n  voxlume convert out.exr out.png");
  command->callback([&action, request] { action = [request] { return convert(*request); }; });
}

}  // namespace voxlume::cli
