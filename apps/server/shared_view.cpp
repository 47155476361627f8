#include "server/shared_view.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cmath>

#include "base/file_extension.h"
#include "scene/scene_file.h"
#include "server/hello.h"
#include "server/outgoing.h"
#include "server/probe.h"
#include "server/viewer.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;

namespace {

using nlohmann::json;

/// A still picture follows the last edit by less than this, unless there is trouble.
constexpr auto kStillPatience = std::chrono::seconds(20);

std::shared_ptr<const std::string> shared_text(const json& message) {
  return std::make_shared<const std::string>(text_of(message));
}

}  // namespace

SharedView::SharedView(boost::asio::io_context& io, Settings settings, Roots roots, Uploads& uploads)
    : io_(io),
      settings_(std::move(settings)),
      files_(std::move(roots), uploads),
      still_timer_(io),
      thumbnails_(io, [this](const std::string& preset) { tell_all(preset_drawn_json(preset)); }),
      exports_(io, settings_.program, settings_.temporary / "exports",
               [this](const Json& m) { take_export_state(m); }),
      opening_(io, settings_.live,
               {.status =
                    [this](const OpeningStatus& status) {
                      if (status.stage == "failed") files_.failed();
                      set_status(status);
                    },
                .opened = [this](std::shared_ptr<OpenedVolume> volume) { opened(std::move(volume)); },
                .frame = [this](const FrameMessage& frame) { take_frame(frame); },
                .trouble = [this](const std::string& message) { tell_trouble(message); },
                .progress = [this](const RenderProgress& progress) { tell_progress(progress); },
                .warnings = [this](const std::vector<std::string>& lines) { tell_warnings(lines); },
                .compiling =
                    [this](double share) {
                      tell_all({{"type", "compiling"}, {"share", share}});
                    }}) {
  set_status({"empty", "", "", {}});
}

SharedView::~SharedView() {
  end();
  document_.reset();
  volume_.reset();
}

void SharedView::open(const SceneDescription& scene, const fs::path& from) {
  files_.begin({scene.volume.path, from});
  opening_.open(scene);
}

void SharedView::opened(std::shared_ptr<OpenedVolume> volume) {
  SceneDescription scene = volume->session->session().description();
  keep_screen_size(scene);
  // What the rules need lives as long as the session, not this object's member.
  const Document::Rules rules{
      .resolve = [session =
                      volume->session.get()](const SceneDescription& s) { return session->resolved(s); },
      .check_paths = [this](SceneDescription& s,
                            const SceneDescription& before) { files_.resolve_edited(s, before); }};
  try {
    Document document(std::move(scene), rules);
    document_.emplace(std::move(document));
  } catch (const Error& error) {
    files_.failed();
    return set_status({"failed", volume->name, error.what(), {}});
  }
  files_.opened(document_->scene());
  if (volume_) opening_.retire(std::move(volume_));
  volume_ = std::move(volume);
  *volume_->numbering = {last_frame_, revision_};
  frame_.reset();
  passing_ = {};
  thumbnails_.forget();
  watch_or_rest();
  volume_->session->set_split(split_);
  volume_->session->set_yielding(exporting_);
  set_status({"ready", volume_->name, "", {}});
  tell_warnings({});
  show();
  tell_scene();
}

void SharedView::keep_screen_size(SceneDescription& scene) const {
  ImageDescription& image = scene.image;
  if (screen_size_) {
    image.width = screen_size_->first;
    image.height = screen_size_->second;
  }
  const double shrink = std::sqrt(static_cast<double>(kMostPixels) / (double(image.width) * image.height));
  if (shrink >= 1) return;
  image.width = std::max(1, static_cast<int>(image.width * shrink));
  image.height = std::max(1, static_cast<int>(image.height * shrink));
}

void SharedView::show() {
  try {
    revision_ = volume_->session->show(passing_.over(*document_)) + volume_->numbering->revisions_before;
  } catch (const Error& error) {
    tell_trouble(error.what());
  }
}

void SharedView::join(const std::shared_ptr<Viewer>& viewer) {
  viewers_[viewer.get()] = viewer;
  watch_or_rest();
  viewer->send(shared_text(hello_message(settings_.samples, settings_.environments, files_.roots())));
  viewer->send(shared_text(status_));
  if (document_) viewer->send(shared_text(scene_message()));
  if (!warnings_.is_null()) viewer->send(shared_text(warnings_));
  if (!exports_.state().is_null()) viewer->send(shared_text(exports_.state()));
  if (split_) viewer->send(shared_text(split_json(split_)));
  if (frame_) viewer->offer(*frame_);
  tell_all({{"type", "viewers"}, {"count", viewers_.size()}});
}

void SharedView::leave(Viewer& viewer) {
  const auto found = viewers_.find(&viewer);
  if (found == viewers_.end()) return;
  viewers_.erase(found);
  if (passing_.leave(viewer)) show();
  watch_or_rest();
  tell_all({{"type", "viewers"}, {"count", viewers_.size()}});
}

void SharedView::close() {
  const auto viewers = viewers_;  // each leaves as it is closed
  for (const auto& [key, viewer] : viewers) viewer->close(boost::beast::websocket::close_code::going_away);
}

void SharedView::end() {
  workers_.stop();
  workers_.join();
  exports_.end();
}

void SharedView::receive(Viewer& viewer, std::string_view text) {
  std::optional<PageMessage> message;
  try {
    message = parse_message(text);
    std::visit([&](const auto& m) { take(viewer, m); }, *message);
  } catch (const Error& error) {
    viewer.send(shared_text(in_words(failure_json(message, text, error))));
  } catch (const std::exception& error) {
    viewer.send(
        shared_text(in_words(failure_json(message, text, Error(ErrorCode::kInternal, "", error.what())))));
  }
}

void SharedView::take(Viewer& from, const EditMessage& message) {
  Document& document = open_document();
  // A gesture is one viewer's; two may call theirs alike.
  const std::string gesture =
      message.gesture.empty() ? "" : std::to_string(from.page_number()) + " " + message.gesture;
  const Json sections = document.edit(message.set, gesture);
  files_.keep(document_->scene());
  if (!sections.empty()) show();
  if (sections.contains("image"))
    screen_size_ = {document.scene().image.width, document.scene().image.height};
  Json edited = edited_message(sections);
  if (!sections.empty()) tell_all(edited, &from);
  edited["seq"] = message.seq;
  from.send(shared_text(edited));
}

void SharedView::take(Viewer& from, const PassingMessage& message) {
  const Document& document = open_document();
  if (!message.set.empty()) document.with(message.set);  // throws what is wrong with it
  if (passing_.set(from, message.set)) show();
  Json edited = edited_message(Json::object());
  edited["seq"] = message.seq;
  from.send(shared_text(edited));
}

void SharedView::take(Viewer&, const UndoMessage&) {
  if (!open_document().undo()) return;
  show();
  tell_scene();
}

void SharedView::take(Viewer&, const RedoMessage&) {
  if (!open_document().redo()) return;
  show();
  tell_scene();
}

void SharedView::take(Viewer&, const LoadMessage& message) {
  SceneDescription scene = parse_scene(text_of(message.scene), "scene");
  files_.resolve(scene, document_ ? scene_paths(document_->scene()) : std::set<std::string>{});
  keep_screen_size(scene);
  if (!document_ || !(scene.volume == document_->scene().volume)) return open(scene);
  document_->replace(scene);
  files_.keep(document_->scene());
  show();
  tell_scene();
}

void SharedView::take(Viewer&, const OpenMessage& message) {
  if (message.path == kPhantomPath) return open(fresh_scene(std::string(kPhantomPath)));
  const fs::path path = files_.to_open(message.path);
  if (lower_extension(path) != ".json") return open(fresh_scene(path.string()), path);
  SceneDescription scene = files_.read(path);
  keep_screen_size(scene);
  if (is_sample(path)) scene.render.denoise = default_view_scene().render.denoise;
  open(scene, path);
}

void SharedView::take(Viewer&, const CancelOpenMessage&) {
  if (status_["stage"] != "reading" && status_["stage"] != "preparing") return;
  opening_.cancel();
  files_.failed();
  status_ = status_json({volume_ ? "ready" : "empty", volume_ ? volume_->name : "", "", {}});
  Json status = status_;
  status["given_up"] = true;
  tell_all(status);
}

bool SharedView::is_sample(const fs::path& path) const {
  return std::any_of(settings_.samples.begin(), settings_.samples.end(),
                     [&](const Sample& sample) { return sample.path == path; });
}

void SharedView::take(Viewer&, const SplitMessage& message) {
  split_ = message.at;
  if (volume_) volume_->session->set_split(split_);
  tell_all(split_json(split_));
}

void SharedView::take(Viewer& from, const SeekMessage& message) {
  open_document();
  if (passing_.seek(from, message.time_s)) show();
}

void SharedView::take(Viewer& from, const ProbeMessage& message) {
  Json answer{{"type", "probe"}, {"id", message.id}, {"hit", false}};
  std::optional<Vec3d> place;
  if (message.position_mm) {
    if (volume_ && is_inside(volume_->session->session().volume(), *message.position_mm))
      place = message.position_mm;
  } else if (frame_) {
    place = place_in_picture(*frame_->frame, message.x, message.y);
  }
  if (!place) return from.send(shared_text(answer));
  work([this, volume = volume_, scene = document_->shared_scene(), place = *place, answer,
        viewer = from.weak_from_this()]() mutable {
    answer["hit"] = true;
    answer.update(data_at(volume->session->session().volume(), place));
    answer["labels"] = labels_at(*scene, *volume->sides, place);
    boost::asio::post(io_, [viewer, text = shared_text(answer)] {
      if (const auto to = viewer.lock()) to->send(text);
    });
  });
}

void SharedView::take(Viewer&, const ExportMessage& message) {
  exports_.start(open_document().scene(), message.file);
}

void SharedView::take(Viewer&, const CancelExportMessage&) { exports_.cancel(); }

void SharedView::take(Viewer& from, const DrawPresetsMessage&) {
  const SceneDescription& scene = open_document().scene();
  for (const std::string& preset : thumbnails_.draw_all(*volume_, scene))
    from.send(shared_text(preset_drawn_json(preset)));
}

void SharedView::take(Viewer& from, const ShownMessage& message) { from.shown(message.frame); }

Document& SharedView::open_document() {
  if (!document_) throw Error(ErrorCode::kBadParameter, "", "nothing is open");
  return *document_;
}

SceneDescription SharedView::fresh_scene(const std::string& path) const {
  SceneDescription scene = default_view_scene();
  scene.volume.path = path;
  keep_screen_size(scene);
  return scene;
}

void SharedView::take_frame(const FrameMessage& frame) {
  frame_ = frame;
  last_frame_ = frame.number;
  for (const auto& [key, viewer] : viewers_) viewer->offer(frame);
  if (is_current_still(frame)) hand_out_stills(frame.frame);
}

void SharedView::take_export_state(const Json& message) {
  exporting_ = message["state"] == "running";
  if (volume_) volume_->session->set_yielding(exporting_);
  tell_all(message);
}

void SharedView::watch_or_rest() {
  if (volume_) volume_->session->set_watched(!viewers_.empty() || !awaiting_still_.empty());
}

bool SharedView::is_current_still(const FrameMessage& frame) const {
  return !frame.frame->moving && frame.frame->revision + volume_->numbering->revisions_before == revision_;
}

void SharedView::with_still_picture(std::function<void(std::shared_ptr<const LiveFrame>)> use) {
  open_document();
  if (frame_ && is_current_still(*frame_)) return use(frame_->frame);
  awaiting_still_.push_back(std::move(use));
  if (awaiting_still_.size() > 1) return;
  watch_or_rest();
  still_timer_.expires_after(kStillPatience);
  still_timer_.async_wait([this](boost::system::error_code failed) {
    if (!failed) hand_out_stills(nullptr);
  });
}

void SharedView::hand_out_stills(const std::shared_ptr<const LiveFrame>& frame) {
  if (awaiting_still_.empty()) return;
  still_timer_.cancel();
  for (const auto& use : std::exchange(awaiting_still_, {})) use(frame);
  watch_or_rest();
}

std::filesystem::path SharedView::temporary_file(const std::string& extension) {
  return settings_.temporary / (std::to_string(++temporary_files_) + extension);
}

void SharedView::work(std::function<void()> job) {
  boost::asio::post(workers_, [job = std::move(job)] {
    try {
      job();
    } catch (const std::exception&) {
      // Out of memory, say: this one is not answered, and all others are.
    }
  });
}

void SharedView::set_status(const OpeningStatus& of) {
  const Json status = in_words(status_json(of));
  // Whoever comes later sees what is open, not what could not be opened.
  status_ = of.stage == "failed" && volume_ ? status_json({"ready", volume_->name, "", {}}) : status;
  tell_all(status);
}

void SharedView::tell_all(const Json& message, const Viewer* but) {
  const auto text = shared_text(message);
  const auto viewers = viewers_;  // one that is full leaves
  for (const auto& [key, viewer] : viewers)
    if (key != but) viewer->send(text);
}

void SharedView::tell_trouble(const std::string& message) {
  tell_all(in_words({{"type", "trouble"}, {"message", message}}));
}

SharedView::Json SharedView::in_words(Json message) const {
  for (const char* key : {"message", "where"})
    if (message.contains(key)) message[key] = files_.uploads().with_names_alone(message[key]);
  return message;
}

void SharedView::tell_warnings(const std::vector<std::string>& lines) {
  Json named = Json::array();
  for (const std::string& line : lines) named.push_back(files_.uploads().with_names_alone(line));
  warnings_ = {{"type", "warnings"}, {"lines", named}};
  tell_all(warnings_);
}

void SharedView::tell_progress(const RenderProgress& progress) {
  const auto text = shared_text(progress_json(progress));
  const auto viewers = viewers_;
  for (const auto& [key, viewer] : viewers) viewer->send_if_idle(text);
}

void SharedView::tell_scene() { tell_all(scene_message()); }

SharedView::Json SharedView::scene_message() const {
  return {{"type", "scene"},
          {"revision", revision_},
          {"scene", document_->json()},
          {"can_undo", document_->can_undo()},
          {"can_redo", document_->can_redo()}};
}

SharedView::Json SharedView::edited_message(const Json& sections) const {
  return {{"type", "edited"},
          {"revision", revision_},
          {"sections", sections},
          {"can_undo", document_->can_undo()},
          {"can_redo", document_->can_redo()}};
}

}  // namespace voxlume::server
