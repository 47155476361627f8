#pragma once
#include <string>
#include <string_view>

#include "server/page_files.h"
#include "server/reply.h"
#include "server/shared_view.h"
#include "server/target.h"

namespace voxlume::server {

/// Answers GET requests of those who may ask. `if_none_match` is the header of that name, or empty.
class Routes {
 public:
  Routes(SharedView& view, PageFiles page) : view_(view), page_(std::move(page)) {}

  void get(const Target& target, std::string_view if_none_match, const Respond& respond) const;

 private:
  Reply page(const std::string& path, std::string_view if_none_match) const;
  void api(const Target& target, const Respond& respond) const;
  /// Answers with what `job` returns, which runs on another thread and may throw Error.
  void work(const Respond& respond, std::function<Reply()> job) const;
  void labels(const Respond& respond) const;
  void histogram(const Target& target, const Respond& respond) const;
  void joint_histogram(const Target& target, const Respond& respond) const;
  void slice(const Target& target, const Respond& respond) const;
  void picture(const std::string& extension, const Respond& respond) const;
  Reply scene_file() const;
  Reply thumbnail(const std::string& preset) const;
  Reply finished_export(const std::string& file) const;

  SharedView& view_;
  PageFiles page_;
};

}  // namespace voxlume::server
