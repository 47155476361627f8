#include "methods.h"

#include <chrono>

#include "render/denoise_frame.h"
#include "voxlume/error.h"

namespace voxlume::study {
namespace {

/// Both classes as one; means stay means and their product the mean radiance.
void merge_classes(DenoiseFrame& frame) {
  SampleClass& a = (*frame.classes)[0];
  SampleClass& b = (*frame.classes)[1];
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      float& n = a.count.at(x, y);
      float& m = b.count.at(x, y);
      if (!(m > 0)) continue;
      for (int c = 0; c < 3; ++c) {
        const auto merge = [&](float& first, float second) { first = (n * first + m * second) / (n + m); };
        const auto merge_light = [&](Planes3 SampleClass::*fx, Planes3 SampleClass::*fl) {
          float& fx_here = (a.*fx)[c].at(x, y);
          float& fl_here = (a.*fl)[c].at(x, y);
          float direct = fx_here * fl_here;
          merge(direct, (b.*fx)[c].at(x, y) * (b.*fl)[c].at(x, y));
          merge(fx_here, (b.*fx)[c].at(x, y));
          fl_here = fx_here > 0 ? direct / fx_here : 0;
        };
        merge_light(&SampleClass::fx_diffuse, &SampleClass::fl_diffuse);
        merge_light(&SampleClass::fx_specular, &SampleClass::fl_specular);
        merge(a.later[c].at(x, y), b.later[c].at(x, y));
      }
      n += m;
      m = 0;
    }
  }
}

/// One class of one quantity: what a denoiser that knows no parts has.
void couple(DenoiseFrame& frame) {
  merge_classes(frame);
  SampleClass& all = (*frame.classes)[0];
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        float& fx_diffuse = all.fx_diffuse[c].at(x, y);
        float& fx_specular = all.fx_specular[c].at(x, y);
        all.later[c].at(x, y) +=
            fx_diffuse * all.fl_diffuse[c].at(x, y) + fx_specular * all.fl_specular[c].at(x, y);
        fx_diffuse = fx_specular = 0;
        all.fl_diffuse[c].at(x, y) = all.fl_specular[c].at(x, y) = 0;
      }
    }
  }
}

const DenoiserKind* decoupled() { return &find_denoiser("decoupled"); }

bool is_available(const DenoiserKind& kind) {
  try {
    kind.make();
    return true;
  } catch (const Error&) {  // the library is not installed
    return false;
  }
}

}  // namespace

Method::Method(std::string name, const DenoiserKind* kind, Change change, bool has_history)
    : name_(std::move(name)),
      denoiser_(kind ? kind->make() : nullptr),
      change_(change),
      has_history_(has_history) {}

double Method::denoise(const DenoiseFrame& frame) {
  const DenoiseFrame* shown = &frame;
  if (change_) {
    changed_ = frame;
    change_(changed_);
    shown = &changed_;
  }
  if (!has_history_) forget();
  const auto begin = std::chrono::steady_clock::now();
  if (denoiser_) {
    denoiser_->denoise(*shown, out_);
  } else {
    out_.radiance = frame.radiance;
    out_.alpha = frame.alpha;
  }
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

Image Method::picture(const DenoiseFrame& frame) const { return compose_picture(frame, out_, false); }

void Method::forget() {
  if (denoiser_) denoiser_->forget();
}

std::vector<Method> every_method(bool all) {
  std::vector<Method> methods;
  methods.emplace_back("noisy", nullptr, nullptr, false);
  for (const DenoiserKind& kind : denoiser_kinds()) {
    const bool alone = kind.name == "atrous" || kind.name == "bilateral" || kind.name == "oidn";
    if (!all && kind.name.ends_with("-no-feature")) continue;
    if (!is_available(kind)) continue;
    methods.emplace_back(std::string(kind.name), &kind, nullptr, !alone);
  }
  return methods;
}

std::vector<Method> ablations() {
  std::vector<Method> methods;
  methods.emplace_back("decoupled-one-class", decoupled(), merge_classes);
  methods.emplace_back("decoupled-no-decoupling", decoupled(), couple);
  return methods;
}

Method still_method() { return Method("decoupled-no-history", decoupled(), nullptr, false); }

}  // namespace voxlume::study
