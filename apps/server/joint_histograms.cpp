#include "server/joint_histograms.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "grid/joint_histogram.h"

namespace voxlume::server {
namespace {

constexpr std::size_t kMostKept = 6;

nlohmann::json axis_json(const JointHistogram::Axis& axis) {
  return {{"lo", axis.lower}, {"hi", axis.upper}};
}

std::string json_text(const JointHistogram& histogram) {
  return nlohmann::json{{"x", axis_json(histogram.x)},
                        {"y", axis_json(histogram.y)},
                        {"columns", histogram.x.bins},
                        {"rows", histogram.y.bins},
                        {"counts", histogram.counts}}
      .dump();
}

}  // namespace

JointHistograms::JointHistograms(Volume main, const VolumeStatistics& statistics)
    : main_(std::move(main)), lower_(statistics.lower), upper_(statistics.upper) {}

std::shared_ptr<const std::string> JointHistograms::find(SideVolumes& sides, const SceneDescription& scene,
                                                         const std::string& x, const std::string& y) {
  const auto side = [&](const std::string& name) {
    return name == "data" ? Side() : sides.find(scene, name);
  };
  const Side of_x = side(x), of_y = side(y);
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const Kept& kept) { return kept.x == of_x && kept.y == of_y; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().json;
  }
  const auto counted = [&](const Side& one) {
    return one ? JointVolume{one->volume, one->labels, one->statistics.lower, one->statistics.upper}
               : JointVolume{main_, false, lower_, upper_};
  };
  const auto json =
      std::make_shared<const std::string>(json_text(joint_histogram(main_, counted(of_x), counted(of_y))));
  kept_.push_front({of_x, of_y, json});
  if (kept_.size() > kMostKept) kept_.pop_back();
  return json;
}

}  // namespace voxlume::server
