#include "render/live_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>

#include "base/parallel.h"
#include "grid/phantom.h"
#include "render/picture.h"
#include "scene/resolve.h"
#include "support/volumes.h"
#include "tonemap/tone_map.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using FramePtr = std::shared_ptr<const LiveFrame>;

Volume ball() {
  return test::make_volume<std::int16_t>({24, 24, 24}, [](auto i, auto j, auto k) {
    const double x = i - 11.5, y = j - 11.5, z = k - 11.5;
    return x * x + y * y + z * z < 100 ? 600 : -1000;
  });
}

SceneDescription small_scene() {
  SceneDescription scene;
  scene.transfer.preset = "ct-bone";
  scene.image.width = 48;
  scene.image.height = 40;
  scene.image.spp = 64;
  return scene;
}

SceneDescription denoised_scene(int spp) {
  SceneDescription scene;
  scene.transfer.preset = "ct-bone";
  scene.image.width = 192;
  scene.image.height = 144;
  scene.image.spp = spp;
  scene.render.denoise = "decoupled";
  return scene;
}

/// Keeps what a session tells.
class Heard {
 public:
  LiveListener listener() {
    LiveListener out;
    out.frame = [this](FramePtr frame) {
      std::unique_lock lock(mutex_);
      frames_.push_back(std::move(frame));
      changed_.notify_all();
      changed_.wait(lock, [this] { return !held_; });
    };
    out.trouble = [this](std::uint64_t revision, const std::string& message) {
      const std::lock_guard lock(mutex_);
      troubles_.emplace_back(revision, message);
      changed_.notify_all();
    };
    return out;
  }

  /// The first frame, of those to come and those that came, for which `pred` holds.
  template <class Pred>
  FramePtr wait_for(Pred&& pred) {
    std::unique_lock lock(mutex_);
    FramePtr found;
    changed_.wait(lock, [&] {
      for (const FramePtr& frame : frames_)
        if (pred(*frame)) found = frame;
      return found != nullptr;
    });
    return found;
  }
  FramePtr wait_done(std::uint64_t revision) {
    return wait_for([&](const LiveFrame& f) { return f.done && f.revision == revision; });
  }
  std::pair<std::uint64_t, std::string> wait_trouble() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !troubles_.empty(); });
    return troubles_.back();
  }
  /// While held the session's thread stays in the listener once it comes there.
  void hold(bool held) {
    const std::lock_guard lock(mutex_);
    held_ = held;
    changed_.notify_all();
  }
  std::vector<FramePtr> frames() {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<FramePtr> frames_;
  std::vector<std::pair<std::uint64_t, std::string>> troubles_;
  bool held_ = false;
};

LiveOptions quick() {
  LiveOptions options;
  options.rest_s = 0.02;
  return options;
}

/// What `voxlume render` makes of the scene.
Image rendered(const LiveSession& live, const SceneDescription& scene) {
  Session session(scene, live.session().volume());
  session.compile(session.description());
  const PictureSamples samples = render_picture(session.compiled(), "", {});
  return finish_picture(samples.state, session.compiled(), {});
}

TEST(LiveSession, IsNotMadeOnceItIsNotWantedAnyMore) {
  std::atomic<bool> outdated{false};
  const CancelScope scope(outdated);
  LiveListener listener;
  listener.preparing = [&](double) { outdated = true; };
  EXPECT_THROW(LiveSession(small_scene(), ball(), listener), Cancelled);
}

TEST(LiveSession, EndsWithThePictureOfTheRenderCommand) {
  Heard heard;
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  const SceneDescription scene = live.session().description();
  const FramePtr frame = heard.wait_done(live.show(scene));
  EXPECT_EQ(frame->spp, 64);
  EXPECT_EQ(frame->limit, LiveLimit::kNothing);
  EXPECT_FALSE(frame->moving);
  ASSERT_TRUE(frame->noise);
  EXPECT_GT(*frame->noise, 0);
  EXPECT_EQ(frame->linear->rgba, rendered(live, scene).rgba);
  EXPECT_EQ(frame->picture.width, 48);
  EXPECT_EQ(frame->linear->metadata.count("voxlume:scene"), 1u);
}

TEST(LiveSession, StopsAtTheNoiseThatTheRenderCommandStopsAt) {
  Heard heard;
  SceneDescription scene = small_scene();
  scene.image.spp.reset();
  scene.image.noise = 0.05;
  LiveSession live(scene, ball(), heard.listener(), quick());
  const FramePtr frame = heard.wait_done(live.show(live.session().description()));
  EXPECT_GT(frame->spp, 8);
  EXPECT_LE(*frame->noise, 0.05);
  EXPECT_EQ(frame->linear->rgba, rendered(live, live.session().description()).rgba);
}

TEST(LiveSession, MovingFramesShrinkForWhatTracingTakes) {
  Heard heard;
  SceneDescription scene = small_scene();
  scene.image.width = scene.image.height = 256;
  scene.render.max_scatter = 100;
  scene.render.denoise = "none";
  // Long enough for all but tracing, which takes several times as long at full size.
  LiveOptions options;
  options.frame_budget_s = 0.02;
  options.rest_s = 1e9;
  LiveSession live(scene, ball(), heard.listener(), options);
  live.show(live.session().description());
  const FramePtr settled = heard.wait_for([](const LiveFrame& f) { return f.number == 30; });
  EXPECT_TRUE(settled->moving);
  EXPECT_LT(settled->picture.width, 256) << "tracing took " << settled->trace_s << " s";
  EXPECT_GT(settled->trace_s, 0);
}

TEST(LiveSession, OfManyEditsFromManyThreadsTheLastWins) {
  Heard heard;
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  const SceneDescription base = live.session().description();
  std::vector<std::future<void>> threads;
  std::mutex mutex;
  std::uint64_t last = 0;
  double azimuth_deg = 0;
  for (int t = 0; t < 4; ++t)
    threads.push_back(std::async(std::launch::async, [&, t] {
      for (int i = 0; i < 50; ++i) {
        SceneDescription scene = base;
        scene.camera.azimuth_deg = 50 * t + i;
        const std::lock_guard lock(mutex);
        last = live.show(scene);
        azimuth_deg = scene.camera.azimuth_deg;
      }
    }));
  for (auto& thread : threads) thread.get();
  EXPECT_EQ(last, 200u);
  SceneDescription scene = base;
  scene.camera.azimuth_deg = azimuth_deg;
  EXPECT_EQ(heard.wait_done(last)->linear->rgba, rendered(live, scene).rgba);
  std::uint64_t revision = 0, number = 0;
  for (const FramePtr& frame : heard.frames()) {
    EXPECT_GE(frame->revision, revision);
    EXPECT_EQ(frame->number, number + 1);
    revision = frame->revision;
    number = frame->number;
  }
}

TEST(LiveSession, ShowReturnsWhileAFrameIsOnItsWay) {
  Heard heard;
  heard.hold(true);
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  SceneDescription scene = live.session().description();
  live.show(scene);
  heard.wait_for([](const LiveFrame&) { return true; });  // and it stays in the listener
  std::uint64_t last = 0;
  for (int i = 0; i < 1000; ++i) {
    scene.camera.azimuth_deg = i;
    last = live.show(scene);
  }
  EXPECT_EQ(last, 1001u);
  EXPECT_EQ(heard.frames().size(), 1u);
  heard.hold(false);
  const FramePtr frame = heard.wait_done(last);
  // Of the thousand none but the last was drawn.
  for (const FramePtr& f : heard.frames()) EXPECT_TRUE(f->revision == 1 || f->revision == last);
  EXPECT_EQ(frame->revision, last);
}

TEST(LiveSession, DevelopmentKeepsTheSamples) {
  Heard heard;
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  SceneDescription scene = live.session().description();
  const FramePtr before = heard.wait_done(live.show(scene));
  scene.image.exposure_ev = 2;
  const std::uint64_t revision = live.show(scene);
  const FramePtr after = heard.wait_done(revision);
  for (const FramePtr& frame : heard.frames())
    if (frame->revision == revision) {
      EXPECT_EQ(frame->spp, 64);
    }
  EXPECT_EQ(after->linear->rgba, before->linear->rgba);
  EXPECT_NE(after->picture.values, before->picture.values);
  // More samples of the same picture go on from those there are.
  scene.image.spp = 96;
  const std::uint64_t more = live.show(scene);
  const FramePtr longer = heard.wait_done(more);
  EXPECT_EQ(longer->spp, 96);
  for (const FramePtr& frame : heard.frames())
    if (frame->revision == more) {
      EXPECT_GE(frame->spp, 64);
    }
  EXPECT_EQ(longer->linear->rgba, rendered(live, scene).rgba);
}

/// Of the pixels as they are on screen, where a small picture fills the place of a large one.
double error_on_screen(const LiveFrame& frame, const Image8& reference) {
  double sum = 0;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const auto at = [](int i, int count, int from) {
        return std::clamp((i + 0.5) * from / count - 0.5, 0.0, from - 1.0);
      };
      const double u = at(x, reference.width, frame.picture.width),
                   v = at(y, reference.height, frame.picture.height);
      const int i = std::min(static_cast<int>(u), frame.picture.width - 2);
      const int j = std::min(static_cast<int>(v), frame.picture.height - 2);
      for (int c = 0; c < 3; ++c) {
        const auto value = [&](int column, int row) {
          return 1.0 *
                 frame.picture.values[static_cast<std::size_t>((row * frame.picture.width + column) * 3 + c)];
        };
        const double top = std::lerp(value(i, j), value(i + 1, j), u - i);
        const double bottom = std::lerp(value(i, j + 1), value(i + 1, j + 1), u - i);
        const double off = std::lerp(top, bottom, v - j) -
                           reference.values[static_cast<std::size_t>((y * reference.width + x) * 3 + c)];
        sum += off * off;
      }
    }
  return std::sqrt(sum / (3.0 * reference.width * reference.height));
}

/// With the time of a frame, which decides how coarse moving pictures are.
class ComingToRest : public testing::TestWithParam<double> {};

TEST_P(ComingToRest, ThePictureGetsNoWorse) {
  Heard heard;
  SceneDescription scene = denoised_scene(64);
  LiveOptions options = quick();
  options.frame_budget_s = GetParam();
  LiveSession live(scene, make_head_phantom(), heard.listener(), options);
  scene = live.session().description();
  for (int i = 0; i < 24; ++i) {
    scene.camera.azimuth_deg += 2;
    const std::uint64_t revision = live.show(scene);
    heard.wait_for([&](const LiveFrame& f) { return f.revision == revision; });
  }
  heard.wait_for([](const LiveFrame& f) { return f.done; });
  SceneDescription other = scene;  // other samples of the same
  other.render.seed += 1;
  other.image.spp = 256;
  const Image8 reference = tone_map(rendered(live, other), {scene.image.exposure_ev, scene.image.tone_curve});
  std::vector<FramePtr> frames = heard.frames();
  const auto stills =
      std::find_if(frames.rbegin(), frames.rend(), [](const FramePtr& f) { return f->moving; });
  ASSERT_TRUE(stills != frames.rbegin() && stills != frames.rend());
  frames.erase(frames.begin(), stills.base() - 1);  // but the last moving one
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LE(error_on_screen(*frames[i], reference), 1.02 * error_on_screen(*frames[i - 1], reference))
        << frames[i]->spp << " spp after " << frames[i - 1]->spp << " of " << frames[i - 1]->picture.width;
  }
}

INSTANTIATE_TEST_SUITE_P(Budgets, ComingToRest, testing::Values(1.0 / 30, 3e-3, 1e-6));

TEST(LiveSession, AMovingPictureGoesOnAfterARestWithWhatItRemembers) {
  SceneDescription scene = denoised_scene(16);
  LiveOptions options = quick();
  options.frame_budget_s = 1e-6;  // as coarse as can be, always
  const auto first_moving = [](Heard& heard, std::uint64_t revision) {
    return heard.wait_for([&](const LiveFrame& f) { return f.revision == revision && f.moving; });
  };
  Heard heard;
  LiveSession live(scene, make_head_phantom(), heard.listener(), options);
  scene = live.session().description();
  double after_rest = 0, fresh = 0;
  for (int round = 0; round < 12; ++round) {
    for (int i = 0; i < 6; ++i) {
      scene.camera.azimuth_deg += 2;
      first_moving(heard, live.show(scene));
    }
    heard.wait_done(live.show(scene));
    scene.camera.azimuth_deg += 2;
    const FramePtr remembers = first_moving(heard, live.show(scene));
    SceneDescription other_matter = scene;
    other_matter.transfer.density_scale *= 0.9;
    first_moving(heard, live.show(other_matter));
    const FramePtr forgot = first_moving(heard, live.show(scene));
    const auto error = [&](const FramePtr& frame) {
      SceneDescription well = scene;
      well.image.width = frame->picture.width;
      well.image.height = frame->picture.height;
      well.image.spp = 256;
      return error_on_screen(
          *frame, tone_map(rendered(live, well), {scene.image.exposure_ev, scene.image.tone_curve}));
    };
    after_rest += error(remembers);
    fresh += error(forgot);
  }
  EXPECT_LT(after_rest, 0.95 * fresh);
}

TEST(LiveSession, AStillPictureIsDevelopedAgainAtOnce) {
  Heard heard;
  SceneDescription scene = small_scene();
  scene.render.denoise = "none";
  scene.image.spp = 8;
  LiveSession live(scene, ball(), heard.listener(), quick());
  scene = live.session().description();
  const FramePtr first = heard.wait_done(live.show(scene));
  std::uint64_t shown = first->number;
  const auto expect_stills = [&](std::uint64_t last) {
    for (const FramePtr& frame : heard.frames())
      if (frame->number > shown) {
        EXPECT_FALSE(frame->moving);
        EXPECT_EQ(frame->spp, 8);
        EXPECT_EQ(frame->picture.width, 48);
      }
    shown = last;
  };
  const auto change = [&](auto edit) {
    edit(scene);
    const std::uint64_t revision = live.show(scene);
    const FramePtr after = heard.wait_done(revision);
    expect_stills(after->number);
    EXPECT_THAT(after->linear->metadata.at("voxlume:scene"), testing::HasSubstr("exposure_ev"));
  };
  change([](SceneDescription& s) { s.image.exposure_ev = 1.5; });
  change([](SceneDescription& s) { s.image.tone_curve = ToneCurve::kSrgb; });
  for (const char* name : {"decoupled", "svgf", "wrls", "none", "decoupled"})
    change([&](SceneDescription& s) { s.render.denoise = name; });
  live.set_split(0.3);
  const FramePtr split = heard.wait_for([&](const LiveFrame& f) { return f.done && f.number > shown; });
  expect_stills(split->number);
}

/// An edit that interrupts a pass leaves some tiles with more samples than others.
TEST(LiveSession, PassesThatAreInterruptedAreFinished) {
  Heard heard;
  SceneDescription scene = small_scene();
  scene.image.width = scene.image.height = 200;
  LiveSession live(scene, ball(), heard.listener(), quick());
  scene = live.session().description();
  std::uint64_t revision = live.show(scene);
  heard.wait_for([](const LiveFrame& f) { return f.moving; });
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  for (int i = 0; i < 40; ++i) {
    scene.image.exposure_ev = 0.05 * i;
    revision = live.show(scene);
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
  }
  const FramePtr frame = heard.wait_done(revision);
  EXPECT_EQ(frame->spp, 64);
  EXPECT_EQ(frame->linear->rgba, rendered(live, scene).rgba);
}

TEST(LiveSession, SplitsThePictureWhereTold) {
  Heard heard;
  SceneDescription scene = small_scene();
  scene.render.denoise = "decoupled";
  scene.image.spp = 4;
  LiveSession live(scene, ball(), heard.listener(), quick());
  const std::uint64_t revision = live.show(live.session().description());
  const FramePtr whole = heard.wait_done(revision);
  live.set_split(0.5);
  const auto differs_at = [&](const LiveFrame& f, int x0, int x1) {
    for (int y = 0; y < 40; ++y)
      for (int i = 3 * (48 * y + x0); i < 3 * (48 * y + x1); ++i)
        if (f.picture.values[static_cast<std::size_t>(i)] !=
            whole->picture.values[static_cast<std::size_t>(i)])
          return true;
    return false;
  };
  const FramePtr split = heard.wait_for([&](const LiveFrame& f) { return f.done && differs_at(f, 0, 24); });
  EXPECT_FALSE(differs_at(*split, 24, 48));
  EXPECT_EQ(split->revision, revision);
  EXPECT_EQ(split->spp, 4);
}

TEST(LiveSession, ATroubledSceneIsToldOfAndTheNextIsDrawn) {
  Heard heard;
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  SceneDescription scene = live.session().description();
  const std::uint64_t good = live.show(scene);
  heard.wait_done(good);
  SceneDescription bad = scene;
  bad.environment->image = "/nowhere/sky.exr";
  const std::uint64_t troubled = live.show(bad);
  const auto [revision, message] = heard.wait_trouble();
  EXPECT_EQ(revision, troubled);
  EXPECT_THAT(message, testing::HasSubstr("/nowhere/sky.exr"));
  scene.camera.azimuth_deg = 10;
  const FramePtr frame = heard.wait_done(live.show(scene));
  EXPECT_EQ(frame->linear->rgba, rendered(live, scene).rgba);
  for (const FramePtr& f : heard.frames()) EXPECT_NE(f->revision, troubled);
}

TEST(LiveSession, DrawsNothingWhileNobodyWatches) {
  Heard heard;
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  SceneDescription scene = live.session().description();
  live.set_watched(false);
  live.show(scene);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(heard.frames().empty());
  live.set_watched(true);
  EXPECT_EQ(heard.wait_done(1)->spp, 64);
}

TEST(LiveSession, DrawsOtherScenesAside) {
  Heard heard;
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  SceneDescription scene = live.session().description();
  SceneDescription aside = scene;
  aside.transfer.preset = "ct-skin";
  aside.transfer.points.clear();
  aside.image.width = aside.image.height = 16;
  aside = live.resolved(aside);
  std::promise<Image8> good, bad;
  live.draw_aside(aside, 8, [&](Image8 picture) { good.set_value(std::move(picture)); });
  const std::uint64_t revision = live.show(scene);
  const Image8 picture = good.get_future().get();
  EXPECT_EQ(picture.width, 16);
  aside.image.spp = 8;
  const Image alone = rendered(live, aside);
  EXPECT_EQ(picture.values, tone_map(alone, {aside.image.exposure_ev, aside.image.tone_curve}).values);
  aside.environment->image = "/nowhere/sky.exr";
  live.draw_aside(aside, 8, [&](Image8 p) { bad.set_value(std::move(p)); });
  EXPECT_EQ(bad.get_future().get().width, 0);
  // What was drawn aside leaves no trace in the picture.
  EXPECT_EQ(heard.wait_done(revision)->linear->rgba, rendered(live, scene).rgba);
}

TEST(LiveSession, YieldsItsStillPictureToOthers) {
  Heard heard;
  SceneDescription scene = small_scene();
  scene.image.spp = 1 << 20;
  LiveSession live(scene, ball(), heard.listener(), quick());
  live.set_yielding(true);
  const std::uint64_t first = live.show(live.session().description());
  const auto still_of = [&](std::uint64_t revision) {
    return heard.wait_for([=](const LiveFrame& f) { return f.revision == revision && !f.moving; });
  };
  const FramePtr shown = still_of(first);
  EXPECT_FALSE(shown->done);
  // Small pictures are drawn, edits are shown as ever, and after the first still one nothing more comes.
  SceneDescription aside = scene;
  aside.image.width = aside.image.height = 16;
  std::promise<Image8> drawn;
  live.draw_aside(live.resolved(aside), 8, [&](Image8 picture) { drawn.set_value(std::move(picture)); });
  EXPECT_EQ(drawn.get_future().get().width, 16);
  scene.camera.azimuth_deg = 40;
  const std::uint64_t second = live.show(live.resolved(scene));
  const double spp = still_of(second)->spp;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(heard.frames().back()->spp, spp);
  live.set_yielding(false);
  heard.wait_for([=](const LiveFrame& f) { return f.revision == second && f.spp > spp; });
}

TEST(LiveSession, EndsWhileItRenders) {
  Heard heard;
  std::promise<Image8> aside;
  {
    SceneDescription scene = small_scene();
    scene.image.width = scene.image.height = 512;
    scene.image.spp = 1 << 20;
    LiveSession live(scene, ball(), heard.listener(), quick());
    live.show(live.session().description());
    heard.wait_for([](const LiveFrame& f) { return !f.moving; });
    live.set_watched(false);
    live.draw_aside(live.session().description(), 1 << 20, [&](Image8 p) { aside.set_value(std::move(p)); });
  }
  EXPECT_EQ(aside.get_future().wait_for(std::chrono::seconds(0)), std::future_status::ready);
}

TEST(LiveSession, KnowsWhereThePictureIs) {
  Heard heard;
  LiveSession live(small_scene(), ball(), heard.listener(), quick());
  const FramePtr frame = heard.wait_done(live.show(live.session().description()));
  // The middle pixel sees the front of the ball, whose centre is the target and whose radius is 10 mm.
  const std::size_t middle = 20u * 48 + 24;
  const float depth_mm = frame->depth_mm[middle];
  const float target_mm = length(frame->camera.target_mm - frame->camera.eye_mm);
  EXPECT_NEAR(depth_mm, target_mm - 10, 1.0f);
  EXPECT_EQ(frame->depth_mm[0], 0);
  EXPECT_NEAR(frame->camera.target_mm.x, 11.5f, 1e-3f);
}

}  // namespace
}  // namespace voxlume
