#include <fmt/format.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/job/job_keys.h"
#include "core/job/key_listing.h"
#include "core/job/layers.h"
#include "core/job/output_names.h"
#include "core/job/read_components.h"
#include "core/job/read_sections.h"
#include "core/job/read_values.h"

/// The top level of a job.
namespace hyades::core {

namespace {

struct UnitRow {
  const char* name;
  float metres;
};

constexpr std::array<UnitRow, 6> kUnits = {{
    {"mm", 0.001F},
    {"cm", 0.01F},
    {"m", 1.0F},
    {"km", 1000.0F},
    {"in", 0.0254F},
    {"ft", 0.3048F},
}};

std::vector<std::string> unit_names() {
  std::vector<std::string> names;
  for (const UnitRow& unit : kUnits) names.emplace_back(unit.name);
  return names;
}

void read_version(MapReader& top) {
  top.require("hyades", "the version of the job language: hyades: 1");
  const YamlNode* node = top.find("hyades");
  if (node != nullptr && node->scalar != "1") {
    top.mismatch("hyades", *node, "1, the only version of the job language so far");
  }
}

void read_name(MapReader& top, Job& job) {
  if (top.listing()) top.tell("name", {.takes = "text"});
  const YamlNode* node = top.find("name");
  if (node == nullptr) return;
  if (node->kind == YamlNode::Kind::scalar && is_valid_name(node->scalar)) {
    job.name = node->scalar;
  } else {
    top.mismatch("name", *node, "letters, digits, '_', '-', '.' and inner spaces, at most 100");
  }
}

void read_units(MapReader& top, Job& job) {
  if (top.listing())
    top.tell("units",
             {.takes = "units", .start = "\"m\"", .range = {1e-12, 1e12}, .names = unit_names()});
  const YamlNode* node = top.find("units");
  if (node == nullptr) return;
  for (const UnitRow& unit : kUnits) {
    if (node->kind == YamlNode::Kind::scalar && node->scalar == unit.name) {
      job.units = unit.metres;
      return;
    }
  }
  double number = 0.0;
  const Range range{1e-12, 1e12};
  if (node->kind == YamlNode::Kind::scalar && !node->quoted && parse_number(node->scalar, number) &&
      range.contains(number)) {
    job.units = static_cast<float>(number);
    return;
  }
  top.mismatch("units", *node, "mm, cm, m, km, in, ft or metres per unit (1e-12 to 1e12)");
}

/// Splats are weighed by the filter around where they land, and this one has no around.
void check_splats(MapReader& top, const Job& job) {
  if (!makes_splats(job.integrator) || job.film.filter.type != FilterKind::center) return;
  top.complain(
      top.where_of("integrator"),
      fmt::format("the integrator is {}, whose light paths may end anywhere on the film, but "
                  "film.filter is center; expected a filter with a radius",
                  job.integrator.type));
}

/// Light paths end anywhere on the film: whether a tile is clean is no matter of its own samples.
void check_noise(MapReader& top, const Job& job) {
  if (job.sampling.noise <= 0.0F || !makes_splats(job.integrator)) return;
  top.complain(
      top.where_of("sampling"),
      fmt::format("sampling has a noise to stop at, which the integrator {} does not know: "
                  "its light paths end anywhere on the film; expected path, or samples "
                  "alone",
                  job.integrator.type));
}

/// The first of the switches that is off for rays other than the camera's; null: none.
const char* hidden_from(const VisibilityDesc& visible) {
  if (!visible.diffuse) return "visible_to_diffuse: false";
  if (!visible.glossy) return "visible_to_glossy: false";
  if (!visible.transmission) return "visible_to_transmission: false";
  if (!visible.volume) return "visible_to_volume: false";
  return visible.shadow ? nullptr : "visible_to_shadow: false";
}

/// A path from a light does not know how the camera's end of it will be scattered, which decides
/// what sees what, and is stopped by whatever it meets.
class RayChecks {
 public:
  RayChecks(MapReader& top, const Job& job) : top_(top), job_(job) {}

  void check() {
    if (!makes_splats(job_.integrator)) return;
    for_each_object(job_, [&](const ObjectDesc& object) {
      const std::string what = "object '" + object.name + "'";
      check(object.visible, object.where, what);
      if (object.emit) check(object.emit->links, "emit of " + what);
    });
    for (const LightDesc& light : job_.lights) {
      check(light.visible, light.where, "light '" + light.name + "'");
      check(light.links, "light '" + light.name + "'");
    }
    if (!job_.environment) return;
    check(job_.environment->visible, job_.environment->where, "the environment");
    check(job_.environment->links, "the environment");
  }

 private:
  void check(const VisibilityDesc& visible, const SourceLocation& where, const std::string& what) {
    if (const char* key = hidden_from(visible)) refuse(where, what, key);
  }
  void check(const LightLinkDesc& links, const std::string& what) {
    if (links.shadow_linking) refuse(links.shadow_linking->where, what, "shadow_linking");
  }
  void refuse(const SourceLocation& where, const std::string& what, const char* key) {
    top_.complain(where, fmt::format("{} has {}, which the integrator {} does not know; expected "
                                     "integrator: path",
                                     what, key, job_.integrator.type));
  }

  MapReader& top_;
  const Job& job_;
};

}  // namespace

void read_job(MapReader& top, Job& job) {
  read_version(top);
  top.leave_to_others("include");  // already merged, see load_job_tree
  if (top.listing()) top.tell("include", {.takes = "files"});
  read_name(top, job);
  read_units(top, job);
  read_frames(top, job.frames);
  read_film(top, job.film);
  read_sampling(top, job.sampling);
  read_integrator(top, job.integrator);
  read_render(top, job.render);
  check_splats(top, job);
  check_noise(top, job);
  read_camera(top, job.camera);
  read_textures(top);
  read_materials(top);
  read_media(top);
  read_groups(top);
  read_objects(top);
  read_lights(top);
  read_environment(top, job);
  read_atmosphere(top, job);
  RayChecks(top, job).check();
  top.flag("keep_films", job.keep_films);
  top.choice("denoise", job.denoise, denoise_names());
  read_color_config(top, job);
  read_outputs(top, job);
  top.finish();
}

std::vector<ListedKey> listed_job_keys() {
  Job job;
  Diagnostics ignored;
  ReadContext context(job, ignored);
  KeyListing listing;
  context.listing = &listing;
  MapReader top(context, empty_map(), "", "", "job");
  read_job(top, job);
  MapReader keys(context, empty_map(), "", "", "animation");
  keys.tell("keys", {.takes = "keys", .required = true});
  read_ease(keys);
  read_repeat(keys);
  return listing.keys();
}

std::set<JobKey> known_job_keys() {
  std::set<JobKey> keys;
  for (const ListedKey& key : listed_job_keys()) keys.insert(key.id);
  return keys;
}

}  // namespace hyades::core
