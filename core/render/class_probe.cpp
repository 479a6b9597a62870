#include "core/render/class_probe.h"

#include <xmmintrin.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/elementary.h"
#include "core/base/fp_mode.h"
#include "core/base/hash.h"
#include "core/geometry/isa.h"
#include "core/job/parse.h"
#include "core/render/hyades_build_id.h"
#include "core/render/probe_scene.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::core {
namespace {

#ifdef __FAST_MATH__
#error "Hyades is compiled without -ffast-math: its pictures are the same on every machine"
#endif

constexpr uint32_t kSweep = 4096;
constexpr uint32_t kMantissas = 1U << 16U;

std::string digest_of(const std::vector<float>& values) {
  return to_hex(sha256(std::as_bytes(std::span(values))));
}

/// Hex digest of every elementary function at arguments from 1e-6 to 4e3.
std::string elementary_digest() {
  const FpMode mode;
  std::vector<float> values;
  for (uint32_t i = 0; i < kSweep; ++i) {
    const float x = std::bit_cast<float>(0x358637BDU + i * 0xFFFFU);
    const float unit = static_cast<float>(i) / static_cast<float>(kSweep);
    for (const float value :
         {core::sin(x), core::cos(x), core::tan(x), core::asin(unit), core::acos(unit),
          core::atan2(unit, 1.0F - x), core::exp(-x), core::expm1(unit), core::log(x),
          core::log1p(x), core::exp2(-x), core::log2(x), core::pow(x, unit), std::sqrt(x)}) {
      values.push_back(value);
    }
  }
  return digest_of(values);
}

/// Hex digest of the processor's approximate reciprocals over two octaves of mantissas.
std::string reciprocal_digest() {
  std::vector<float> values;
  for (uint32_t i = 0; i < kMantissas; ++i) {
    const __m128 x = _mm_set_ss(std::bit_cast<float>(0x3F800000U + (i << 8U)));
    values.push_back(_mm_cvtss_f32(_mm_rcp_ss(x)));
    values.push_back(_mm_cvtss_f32(_mm_rsqrt_ss(x)));
  }
  return digest_of(values);
}

}  // namespace

std::string build_id() { return HYADES_BUILD_ID; }

std::string sources_id() { return HYADES_SOURCES_ID; }

Result<Film> render_class_probe(RenderClass which, int threads) {
  const auto assets = make_probe_assets();
  Diagnostics diagnostics;
  Job job = parse_job(kProbeJob, "class probe", *assets, diagnostics);
  if (!diagnostics.empty()) return Error{diagnostics.to_string()};
  job.render.render_class = which;
  SceneCache cache(*assets);
  auto scene = build_scene(job, job.frames.first, cache);
  if (!scene) return scene.error().in("class probe");
  const FrameRenderer renderer(*scene, job, job.frames.first, {true, true, true});
  RenderFrameOptions options;
  options.threads = threads;
  options.tile_size = 8;
  return render_frame(renderer, render_window(job.film), job.sampling.samples, job.frames.first,
                      options)
      .film;
}

Result<ClassProbe> probe_class(RenderClass which, int threads) {
  ClassProbe probe;
  probe.of = which;
  auto film = render_class_probe(which, threads);
  if (!film) return film.error();
  probe.film = film->digest();
  probe.elementary = elementary_digest();
  if (which == RenderClass::portable) {
    probe.build = sources_id();
    return probe;
  }
  auto isa = embree_isa();
  if (!isa) return isa.error();
  probe.build = build_id();
  probe.reciprocals = reciprocal_digest();
  probe.embree = loaded_embree_version() + " " + *isa;
  return probe;
}

std::string class_of(const ClassProbe& probe) {
  const char* title =
      probe.of == RenderClass::native ? "hyades class 1" : "hyades portable class 1";
  return to_hex(sha256(title + ("\n" + probe.film) + "\n" + probe.elementary + "\n" +
                       probe.reciprocals + "\n" + probe.build + "\n" + probe.embree + "\n"));
}

Result<std::string> this_class(RenderClass which) {
  const auto measure = [](RenderClass of) {
    const auto probe = probe_class(of);
    return probe ? Result<std::string>(class_of(*probe)) : Result<std::string>(probe.error());
  };
  if (which == RenderClass::portable) {
    static const Result<std::string> portable = measure(RenderClass::portable);
    return portable;
  }
  static const Result<std::string> native = measure(RenderClass::native);
  return native;
}

}  // namespace hyades::core
