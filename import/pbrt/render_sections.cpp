#include "import/pbrt/render_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "import/pbrt/camera.h"
#include "import/pbrt/motion.h"

namespace hyades::core::pbrt {
namespace {

constexpr int kMostPixels = 65536;

YamlPtr crop_of(ParameterReader& film, const FilmSize& size) {
  const auto bounds = film.integers("pixelbounds");
  const auto window = film.numbers("float", "cropwindow");
  std::array<int, 4> crop{0, 0, size.width, size.height};  // x0, y0, x1, y1
  if (window.size() == 4) {
    const auto at = [](float a, float b, bool upper) {
      return std::clamp(upper ? std::max(a, b) : std::min(a, b), 0.0F, 1.0F);
    };
    const auto pixel = [](int all, float share) {
      return static_cast<int>(std::ceil(static_cast<float>(all) * share));
    };
    crop = {pixel(size.width, at(window[0], window[1], false)),
            pixel(size.height, at(window[2], window[3], false)),
            pixel(size.width, at(window[0], window[1], true)),
            pixel(size.height, at(window[2], window[3], true))};
  } else if (bounds.size() == 4) {
    crop = {std::max(bounds[0], 0), std::max(bounds[2], 0), std::min(bounds[1], size.width),
            std::min(bounds[3], size.height)};
  } else if (!window.empty() || !bounds.empty()) {
    film.report().error(film.place(), "a film's cropwindow and pixelbounds have 4 values");
    return nullptr;
  }
  if (crop[0] >= crop[2] || crop[1] >= crop[3]) {
    film.report().error(film.place(), "nothing is left of the film by its crop");
    return nullptr;
  }
  if (crop == std::array<int, 4>{0, 0, size.width, size.height}) return nullptr;
  std::vector<YamlPtr> numbers;
  for (const int n : crop) numbers.push_back(yaml_integer(n));
  return yaml_list(std::move(numbers));
}

YamlPtr filter_node(Context& context) {
  const Entity& entity = context.scene.filter;
  ParameterReader filter(entity.parameters, entity.place, context.report);
  struct Kind {
    const char* name;
    const char* ours;
    float radius;
  };
  constexpr std::array<Kind, 5> kKinds{{{"box", "box", 0.5F},
                                        {"gaussian", "gaussian", 1.5F},
                                        {"mitchell", "mitchell", 2.0F},
                                        {"triangle", "triangle", 2.0F},
                                        {"sinc", "mitchell", 4.0F}}};
  const auto* kind = std::find_if(kKinds.begin(), kKinds.end(),
                                  [&](const Kind& k) { return entity.type == k.name; });
  if (kind == kKinds.end()) {
    context.report.error(entity.place, "there is no filter '" + entity.type + "'");
    return nullptr;
  }
  const float x = filter.number("xradius", kind->radius);
  const float y = filter.number("yradius", kind->radius);
  float radius = std::sqrt(x * y);
  if (x != y) context.report.note(entity.place, "the filter is as wide as high here");
  if (entity.type == "gaussian") {
    const float sigma = filter.number("sigma", 0.5F);
    if (std::abs(3.0F * sigma - radius) > 0.01F * radius) {
      context.report.note(entity.place, "the Gaussian's radius becomes 3 sigma");
      radius = 3.0F * sigma;
    }
  } else if (entity.type == "mitchell") {
    for (const char* name : {"B", "C"}) {
      if (std::abs(filter.number(name, 1.0F / 3.0F) - 1.0F / 3.0F) > 1e-3F) {
        context.report.note(entity.place, "Mitchell's filter has B = C = 1/3 here");
      }
    }
  } else if (entity.type == "sinc") {
    filter.number("tau", 3.0F);
    radius = 2.0F;
    context.report.note(entity.place, "a filter of Mitchell's stands in for a windowed sinc");
  }
  filter.note_unused();
  if (!(radius > 0.0F) || radius > 16.0F) {
    context.report.error(entity.place, "the filter's radius is not between 0 and 16 pixels");
    return nullptr;
  }
  return YamlMap{{"type", yaml_word(kind->ours)}, {"radius", yaml_number(radius)}}.node();
}

void add_film(Context& context, YamlMap& out) {
  const Entity& entity = context.scene.film;
  ParameterReader film(entity.parameters, entity.place, context.report);
  if (entity.type != "rgb" && entity.type != "gbuffer") {
    context.report.note(entity.place, "a film of type '" + entity.type + "' becomes one of RGB");
  }
  film.text("filename");
  film.flag("savefp16", true);
  film.number("diagonal", 35.0F);
  film.text("coordinatesystem");
  const FilmSize size = film_size(context);
  film.integer("xresolution", 0);
  film.integer("yresolution", 0);
  if (size.width < 1 || size.height < 1 || size.width > kMostPixels || size.height > kMostPixels) {
    context.report.error(entity.place, "the film's resolution is not between 1 and 65536");
    return;
  }
  YamlMap node;
  node.put("size", yaml_list({yaml_integer(size.width), yaml_integer(size.height)}));
  if (YamlPtr crop = crop_of(film, size)) node.put("crop", crop);
  if (YamlPtr filter = filter_node(context)) node.put("filter", filter);
  out.put("film", node);

  const Shutter shutter = shutter_of(context);
  context.exposure =
      static_cast<float>(shutter.close - shutter.open) * film.number("iso", 100.0F) / 100.0F;
  if (!(context.exposure > 0.0F)) {
    context.report.error(context.scene.camera.place,
                         "the shutter is never open or the film's iso is not above 0: the picture "
                         "would be black");
  }
  const std::string sensor = film.text("sensor", "cie1931");
  if (sensor != "cie1931") {
    context.report.note(entity.place, "the colours of the sensor '" + sensor +
                                          "' become those of the CIE 1931 observer");
  }
  if (film.number("whitebalance", 0.0F) != 0.0F) {
    context.report.note(entity.place, "white balance is left out");
  }
  if (film.number_if("maxcomponentvalue")) {
    context.report.note(entity.place,
                        "maxcomponentvalue is left out: light is not clamped (integrator: clamp)");
  }
  film.note_unused();
}

void add_sampling(Context& context, YamlMap& out) {
  const Entity& entity = context.scene.sampler;
  ParameterReader sampler(entity.parameters, entity.place, context.report);
  YamlMap node;
  int samples = sampler.integer("pixelsamples", entity.type == "independent" ? 4 : 16);
  if (entity.type == "stratified") {
    samples = sampler.integer("xsamples", 4) * sampler.integer("ysamples", 4);
    sampler.flag("jitter", true);
  }
  sampler.text("randomization");
  if (samples < 1 || samples > 16'777'216) {
    context.report.error(entity.place, "samples per pixel are not between 1 and 16777216");
    return;
  }
  node.put("samples", yaml_integer(samples));
  if (const int seed = sampler.integer("seed", 0); seed > 0) node.put("seed", yaml_integer(seed));
  if (entity.type == "independent") node.put("sampler", yaml_word("independent"));
  sampler.note_unused();
  out.put("sampling", node);
}

void add_integrator(Context& context, YamlMap& out) {
  const Entity& entity = context.scene.integrator;
  ParameterReader integrator(entity.parameters, entity.place, context.report);
  std::string type = "path";
  if (entity.type == "bdpt" || entity.type == "mlt") {
    type = entity.type;
  } else if (entity.type == "sppm" || entity.type == "lightpath") {
    // Made for what paths from the eye do not find.
    type = "bdpt";
    context.report.note(entity.place, "bidirectional path tracing stands in for the integrator '" +
                                          entity.type + "'");
  } else if (entity.type != "volpath" && entity.type != "path") {
    context.report.note(entity.place,
                        "path tracing stands in for the integrator '" + entity.type + "'");
  }
  const int depth = integrator.integer("maxdepth", 5);
  if (depth < 0 || depth > 65536) {
    context.report.error(entity.place, "maxdepth is not between 0 and 65536");
    return;
  }
  YamlMap node;
  node.put("type", yaml_word(type)).put("max_depth", yaml_integer(depth));
  if (type == "mlt") {
    node.put("large_step",
             yaml_number(std::clamp(integrator.number("largestepprobability", 0.3F), 0.01F, 1.0F)));
    for (const char* name : {"bootstrapsamples", "chains", "mutationsperpixel"}) {
      if (integrator.integer(name, -1) >= 0) {
        context.report.note(entity.place, std::string(name) +
                                              " is left out: samples say how long "
                                              "chains are");
      }
    }
    integrator.number("sigma", 0.01F);
  }
  integrator.text("lightsampler");
  if (integrator.flag("regularize", false)) {
    context.report.note(entity.place, "regularize is left out: surfaces stay as they are");
  }
  integrator.note_unused();
  out.put("integrator", node);
}

}  // namespace

void add_render_sections(Context& context, YamlMap& out) {
  if (scene_moves(context.scene)) {
    out.put("frames", YamlMap{{"range", yaml_word("1")}, {"shutter", yaml_number(1.0F)}});
  }
  add_film(context, out);
  add_sampling(context, out);
  add_integrator(context, out);
}

}  // namespace hyades::core::pbrt
