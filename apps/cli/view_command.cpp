#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "base/memory.h"
#include "cli/commands.h"
#include "cli/open_browser.h"
#include "cli/scene_flags.h"
#include "scene/scene_file.h"
#include "scene/validate.h"
#include "server/access.h"
#include "server/hello.h"
#include "server/page_files.h"
#include "server/server.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

namespace fs = std::filesystem;

/// Rendering's share of a frame: a browser on the same machine takes and draws the picture in what is left.
constexpr double kFrameBudget_s = 1.0 / 22;

/// What the user asked `voxlume view` for.
struct ViewRequest {
  std::string input, folder, address = "127.0.0.1";
  int port = 0, threads = 0;
  double max_upload_gb = 8;
  bool no_open = false;
  SceneFlags flags;
};

fs::path program_path() {
  std::error_code failed;
  const fs::path path = fs::canonical("/proc/self/exe", failed);
  if (failed) throw Error(ErrorCode::kInternal, "/proc/self/exe", failed.message());
  return path;
}

/// VOXLUME_SAMPLES, or data/ of the source folder that the program was built in; empty where there is none.
fs::path samples_folder(const fs::path& program) {
  const char* const chosen = std::getenv("VOXLUME_SAMPLES");
  const fs::path folder = chosen != nullptr && *chosen != '\0'
                              ? fs::path(chosen)
                              : program.parent_path().parent_path().parent_path() / "data";
  std::error_code ignored;
  return fs::is_directory(folder, ignored) ? fs::canonical(folder, ignored) : fs::path();
}

/// The scene to begin with, its paths absolute.
SceneDescription first_scene(const ViewRequest& request) {
  SceneDescription scene = scene_of_input(request.input);
  const bool is_volume = scene.volume.path == request.input;
  if (is_volume) scene.render.denoise = server::default_view_scene().render.denoise;
  request.flags.apply(scene);
  validate_scene(scene, request.input + ": /");
  for_each_path(scene, [](std::string& path) {
    std::error_code failed;
    if (!fs::exists(path, failed)) throw Error(ErrorCode::kFileNotFound, path, "no such file or folder");
    path = fs::canonical(path).string();
  });
  return scene;
}

fs::path default_folder(const std::string& input) {
  std::error_code ignored;
  if (input.empty() || input == kPhantomPath) return fs::current_path();
  const fs::path path = fs::canonical(input, ignored);
  return path.has_parent_path() ? path.parent_path() : fs::current_path();
}

int view(const ViewRequest& request) {
  const fs::path program = program_path();
  server::ServerOptions options;
  options.address = request.address;
  options.port = static_cast<unsigned short>(request.port);
  if (!request.input.empty()) options.scene = first_scene(request);
  options.folder = request.folder.empty() ? default_folder(request.input) : fs::path(request.folder);
  options.program = program;
  options.samples = samples_folder(program);
  options.page = server::PageFiles::find(program);
  options.most_upload_bytes = static_cast<std::uint64_t>(request.max_upload_gb * 1e9);
  options.live.threads = request.threads;
  options.live.frame_budget_s = kFrameBudget_s;
  give_back_large_blocks();
  server::Server server(options);
  if (!server::is_loopback(request.address))
    fmt::print(stderr,
               "warning: listening at {}: whoever has the address that is printed below can see and change "
               "the picture and read the files of the folder, and nothing is encrypted on its way\n",
               request.address);
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  if (!request.no_open) open_browser(server.url());
  server.run();
  return kDone;
}

constexpr const char* kNotes = R"(
The address that is printed holds a secret; whoever has it can use the viewer. Pages may open what lies in
the folder (--folder), what is uploaded, and the samples. Ctrl-C ends the viewer.

From another machine, through a tunnel:
  ssh -L 8080:127.0.0.1:8080 HOST voxlume view head-ct.nrrd --port 8080 --no-open

Examples:
  voxlume view head-ct.nrrd
  voxlume view head-ct.nrrd --preset ct-skin --no-open
  voxlume view scene.json --folder /data --threads 8)";

}  // namespace

void add_view_command(CLI::App& program, Action& action) {
  CLI::App* const command = program.add_subcommand("view", "Look at a volume or scene in the web browser");
  const auto request = std::make_shared<ViewRequest>();
  command->add_option("INPUT", request->input,
                      "Volume file, DICOM folder, scene (.json) or \"phantom\"; may be chosen later");
  command->add_option("--port", request->port, "Port to listen at; 0, the default, takes any that is free")
      ->type_name("P")
      ->check(CLI::Range(0, 65535));
  command->add_option("--bind", request->address, "Address to listen at; 127.0.0.1 by default")
      ->type_name("ADDR");
  command
      ->add_option("--folder", request->folder,
                   "Folder whose files the page may open; INPUT's by default, else the working folder")
      ->type_name("DIR");
  command->add_flag("--no-open", request->no_open, "Do not start the web browser");
  command->add_option("--max-upload", request->max_upload_gb, "Most that pages may upload; 8 by default")
      ->type_name("GB")
      ->check(CLI::Range(0.0, 1e6));
  request->flags.add_to(*command);
  command->add_option("--threads", request->threads, "Threads to use; all by default")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->footer(kNotes);
  command->callback([&action, request] { action = [request] { return view(*request); }; });
}

}  // namespace voxlume::cli
