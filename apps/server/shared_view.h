#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/document.h"
#include "server/exports.h"
#include "server/hello.h"
#include "server/messages.h"
#include "server/opening.h"
#include "server/passing.h"
#include "server/scene_files.h"
#include "server/thumbnails.h"

namespace voxlume::server {

class Viewer;

/// The one volume, scene and picture that everybody who is connected sees and changes. Everything happens on
/// the thread of its io_context.
class SharedView {
 public:
  struct Settings {
    LiveOptions live;
    std::vector<Sample> samples;
    std::filesystem::path environments;  ///< a folder of environment maps beside the user's own; may be empty
    std::filesystem::path program;       ///< what renders animations
    std::filesystem::path temporary;     ///< a folder for what is removed at the end
  };

  /// `uploads` are below one of the roots.
  SharedView(boost::asio::io_context& io, Settings settings, Roots roots, Uploads& uploads);
  ~SharedView();

  const Roots& roots() const { return files_.roots(); }
  const Uploads& uploads() const { return files_.uploads(); }

  /// Opens a scene and its volume, whose paths may be read, instead of what is open. `from` is the path that
  /// was asked for, where one was.
  void open(const SceneDescription& scene, const std::filesystem::path& from = {});

  void join(const std::shared_ptr<Viewer>& viewer);
  void leave(Viewer& viewer);
  /// A text frame of a viewer. Whatever it says, nothing is thrown.
  void receive(Viewer& viewer, std::string_view text);
  /// Says goodbye to all viewers.
  void close();
  /// Ends what other processes do; after this no file is written any more.
  void end();

  /// Another one for every page; what pages call alike is told apart by it.
  std::uint64_t next_page_number() { return ++page_numbers_; }
  std::size_t viewer_count() const { return viewers_.size(); }
  /// Null while none is open.
  std::shared_ptr<OpenedVolume> volume() const { return volume_; }
  /// Null while none is open.
  const Document* document() const { return document_ ? &*document_ : nullptr; }
  const Exports& exports() const { return exports_; }
  /// A name for a file that is removed at the latest at the end; another one every time.
  std::filesystem::path temporary_file(const std::string& extension);

  const Thumbnails& thumbnails() const { return thumbnails_; }
  /// Calls `use` with the picture of the scene as it is now at its full size, as soon as there is one; with
  /// null where that takes too long.
  void with_still_picture(std::function<void(std::shared_ptr<const LiveFrame>)> use);
  /// Does what takes a while on another thread, where it ends with what it throws.
  void work(std::function<void()> job);

 private:
  using Json = nlohmann::json;

  void take(Viewer& from, const EditMessage& message);
  void take(Viewer& from, const PassingMessage& message);
  void take(Viewer& from, const UndoMessage&);
  void take(Viewer& from, const RedoMessage&);
  void take(Viewer& from, const LoadMessage& message);
  void take(Viewer& from, const OpenMessage& message);
  void take(Viewer& from, const CancelOpenMessage&);
  void take(Viewer& from, const SplitMessage& message);
  void take(Viewer& from, const SeekMessage& message);
  void take(Viewer& from, const ProbeMessage& message);
  void take(Viewer& from, const ExportMessage& message);
  void take(Viewer& from, const CancelExportMessage&);
  void take(Viewer& from, const DrawPresetsMessage&);
  void take(Viewer& from, const ShownMessage& message);

  /// Throws Error while nothing is open.
  Document& open_document();
  bool is_sample(const std::filesystem::path& path) const;
  /// What a volume file is opened with.
  SceneDescription fresh_scene(const std::string& path) const;
  void opened(std::shared_ptr<OpenedVolume> volume);
  void take_frame(const FrameMessage& frame);
  void take_export_state(const Json& message);
  void watch_or_rest();
  bool is_current_still(const FrameMessage& frame) const;
  void hand_out_stills(const std::shared_ptr<const LiveFrame>& frame);
  void set_status(const OpeningStatus& of);
  void show();
  void tell_all(const Json& message, const Viewer* but = nullptr);
  void tell_trouble(const std::string& message);
  void tell_warnings(const std::vector<std::string>& lines);
  /// What a message says went wrong, in words for the page.
  Json in_words(Json message) const;
  void tell_progress(const RenderProgress& progress);
  void tell_scene();
  Json scene_message() const;
  Json edited_message(const Json& sections) const;
  void keep_screen_size(SceneDescription& scene) const;

  boost::asio::io_context& io_;
  const Settings settings_;
  SceneFiles files_;
  std::map<const Viewer*, std::shared_ptr<Viewer>> viewers_;
  std::uint64_t page_numbers_ = 0;

  std::shared_ptr<OpenedVolume> volume_;
  std::optional<Document> document_;
  std::uint64_t revision_ = 0;  ///< what was asked for last, as viewers know it
  bool exporting_ = false;      ///< an animation is being rendered
  std::optional<FrameMessage> frame_;
  std::uint64_t last_frame_ = 0;  ///< number of the newest frame, as viewers know it
  Json status_;
  Json warnings_;                                   ///< the message that tells of them; null: not known yet
  std::optional<std::pair<int, int>> screen_size_;  ///< what a page asked for last
  std::optional<double> split_;
  Passing passing_;
  int temporary_files_ = 0;
  std::vector<std::function<void(std::shared_ptr<const LiveFrame>)>> awaiting_still_;
  boost::asio::steady_timer still_timer_;
  Thumbnails thumbnails_;
  Exports exports_;
  Opening opening_;
  boost::asio::thread_pool workers_{2};
};

}  // namespace voxlume::server
