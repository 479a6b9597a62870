#include "tests/core/job/documented_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace hyades::core {
namespace {

std::string trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// What stands between backticks, each piece.
std::vector<std::string> quoted_parts(const std::string& text) {
  std::vector<std::string> parts;
  size_t at = 0;
  while ((at = text.find('`', at)) != std::string::npos) {
    const size_t end = text.find('`', at + 1);
    if (end == std::string::npos) break;
    parts.push_back(text.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return parts;
}

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::stringstream stream(row.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

/// Keys that exclude each other, or that only work together.
Pairs company(const JobKey& id) {
  if (id == JobKey{"materials.conductor", "eta"}) return {{"k", "3"}};
  if (id == JobKey{"materials.conductor", "k"}) return {{"eta", "1.2"}};
  if (id == JobKey{"materials.conductor", "edge"}) return {{"color", "0.7"}};
  if (id == JobKey{"materials.principled", "emission_color"}) return {{"emission_strength", "2"}};
  if (id == JobKey{"materials.principled", "diffuse_transmission"})
    return {{"thin_walled", "true"}};
  if (id == JobKey{"sampling", "min_samples"}) return {{"noise", "0.1"}};
  if (id == JobKey{"integrator.bdpt", "mis"}) return {{"strategy", "[1, 2]"}};
  if (id == JobKey{"textures.mapping", "space"}) return {{"type", "spherical"}};
  if (id == JobKey{"textures.mapping", "blend"}) return {{"type", "triplanar"}};
  if (id == JobKey{"media.emission", "kelvin"}) return {{"temperature", "heat"}};
  if (id == JobKey{"objects", "animation"}) return {{"gltf", "robot.glb"}};
  if (id == JobKey{"objects", "loop"}) return {{"gltf", "robot.glb"}};
  if (id == JobKey{"media", "albedo"}) return {{"density", "2"}};
  if (id == JobKey{"media", "density"}) return {{"albedo", "0.5"}};
  if (id == JobKey{"media", "mean_free_path"}) return {{"albedo", "0.5"}};
  return {};
}

bool excludes(const JobKey& id, const std::string& other) {
  if (id.key == other || id.key == "like") return true;
  const bool of_density = id.section == "media.density";
  const std::vector<std::string> kinds =
      of_density ? std::vector<std::string>{"vdb", "noise", "shell"}
                 : std::vector<std::string>{"shape", "mesh", "curves", "instance",  "group",
                                            "gltf",  "pbrt", "obj",    "animation", "loop"};
  const auto is_kind = [&](const std::string& k) {
    return std::find(kinds.begin(), kinds.end(), k) != kinds.end();
  };
  return (of_density || id.section == "objects") && is_kind(id.key) && is_kind(other);
}

}  // namespace

std::vector<DocumentedKey> read_page() {
  std::ifstream page("docs/job.md");
  EXPECT_TRUE(page.good()) << "docs/job.md must be readable from the working directory";
  std::vector<DocumentedKey> keys;
  std::vector<std::string> sections;
  bool in_table = false;
  int number = 0;
  for (std::string line; std::getline(page, line);) {
    ++number;
    if (line.starts_with("#")) sections = quoted_parts(line);
    if (!line.starts_with("|")) {
      in_table = false;
      continue;
    }
    if (line.starts_with("| key ")) in_table = true;
    if (!in_table || line.starts_with("| key ") || line.starts_with("| ---")) continue;
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), 7U) << "docs/job.md:" << number;
    if (cells.size() != 7) continue;
    EXPECT_FALSE(sections.empty()) << "docs/job.md:" << number << ": a table without a section";
    for (const std::string& section : sections) {
      DocumentedKey key;
      key.id = {section, cells[0]};
      key.type = cells[1];
      key.required = cells[3] == "required";
      const auto defaults = quoted_parts(cells[3]);
      if (!defaults.empty()) key.default_value = defaults[0];
      const auto examples = quoted_parts(cells[5]);
      if (!examples.empty()) key.example = examples[0];
      key.line = number;
      keys.push_back(key);
    }
  }
  return keys;
}

const std::map<std::string, Place>& places() {
  static const std::map<std::string, Place> all = [] {
    std::map<std::string, Place> p;
    p["animation"] = {"camera: {fov: {", {{"keys", "{1: 30, 10: 60}"}}, "}}"};
    p["frames"] = {"frames: {", {{"range", "1-10"}}, "}"};
    p["film"] = {"film: {", {{"size", "[640, 360]"}}, "}"};
    p["film.filter"] = {"film: {filter: {", {}, "}}"};
    p["sampling"] = {"sampling: {", {}, "}"};
    p["render"] = {"render: {", {}, "}"};
    p["integrator"] = {"integrator: {", {}, "}"};
    p["integrator.path"] = p["integrator"];
    p["integrator.bdpt"] = {"integrator: {", {{"type", "bdpt"}}, "}"};
    p["integrator.mlt"] = {"integrator: {", {{"type", "mlt"}}, "}"};
    p["camera"] = {"camera: {", {}, "}"};
    p["camera.perspective"] = p["camera"];
    p["camera.orthographic"] = {"camera: {", {{"type", "orthographic"}}, "}"};
    p["camera.equirectangular"] = {"camera: {", {{"type", "equirectangular"}}, "}"};
    p["camera.exposure"] = {"camera: {exposure: {", {}, "}}"};
    p["camera.aperture"] = {"camera: {aperture: {", {}, "}}"};
    p["environment"] = {"environment: {", {}, "}"};
    p["environment.sky"] = {"environment: {sky: {", {}, "}}"};
    const auto named = [&](const std::string& key, const std::string& type, const Pairs& more) {
      Place place{key + ": {x: {", {{"type", type}}, "}}"};
      place.pairs.insert(place.pairs.end(), more.begin(), more.end());
      return place;
    };
    p["textures"] = named("textures", "perlin3d", {});
    for (const char* type :
         {"checker", "brick", "stripes", "grid", "gradient", "perlin3d", "perlin4d", "fbm3d",
          "fbm4d", "turbulence", "ridged", "marble", "wood", "cellular"}) {
      p[std::string("textures.") + type] = named("textures", type, {});
    }
    p["textures.constant"] = named("textures", "constant", {{"value", "0.5"}});
    p["textures.image"] = named("textures", "image", {{"file", "bricks.png"}});
    p["textures.mapping"] = {"textures: {x: {type: marble, mapping: {", {}, "}}}"};
    for (const char* type : {"scale", "invert", "remap", "threshold", "hue-saturation"}) {
      p[std::string("textures.") + type] = named("textures", type, {{"input", "marble"}});
    }
    p["textures.power"] = named("textures", "power", {{"input", "marble"}, {"exponent", "3"}});
    p["textures.channel"] = named("textures", "channel", {{"input", "marble"}, {"channel", "red"}});
    p["textures.vertex-color"] = named("textures", "vertex-color", {});
    p["textures.ramp"] =
        named("textures", "ramp", {{"input", "tiles"}, {"stops", "{0: 0.2, 1: 0.7}"}});
    for (const char* type : {"add", "divide", "min", "max", "mix"}) {
      p[std::string("textures.") + type] = named("textures", type, {{"a", "marble"}, {"b", "0.3"}});
    }
    p["materials"] = named("materials", "lambert", {});
    for (const char* type : {"lambert", "dielectric", "thin-dielectric", "conductor", "glossy",
                             "mirror", "principled", "diffuse-transmission", "sheen", "hair"}) {
      p[std::string("materials.") + type] = named("materials", type, {});
    }
    p["materials.mix"] = named("materials", "mix", {{"first", "steel"}, {"second", "clay"}});
    p["materials.coat"] = named("materials", "coat", {{"base", "steel"}});
    p["materials.two-sided"] =
        named("materials", "two-sided", {{"front", "steel"}, {"back", "clay"}});
    p["materials.normal_map"] = {
        "materials: {x: {type: lambert, normal_map: {", {{"texture", "marble"}}, "}}}"};
    p["materials.solids"] = p["materials"];
    p["materials.surfaces"] = p["materials"];
    p["materials.subsurface"] = named("materials", "dielectric", {});
    p["materials.subsurface.body"] = {
        "materials: {x: {type: dielectric, subsurface: {", {{"radius", "0.1"}}, "}}}"};
    p["materials.bump"] = {
        "materials: {x: {type: lambert, bump: {", {{"texture", "marble"}}, "}}}"};
    const auto object = [](const std::string& key, const std::string& value) {
      return Place{"objects: {x: {", {{key, value}}, "}}"};
    };
    p["objects"] = object("shape", "sphere");
    for (const char* shape : {"sphere", "disk", "rectangle", "box", "cylinder"}) {
      p[std::string("objects.") + shape] = object("shape", shape);
    }
    p["objects.shapes"] = p["objects"];
    p["objects.bodies"] = p["objects"];
    p["media"] = {"media: {x: {", {}, "}}"};
    p["media.density"] = {"media: {x: {scattering: 2, density: {", {{"vdb", "smoke.vdb"}}, "}}}"};
    p["media.density.shell"] = {
        "media: {x: {scattering: 2, density: {shell: {", {{"image", "bricks.png"}}, "}}}}"};
    p["media.emission"] = {
        "media: {x: {scattering: 2, density: {vdb: smoke.vdb}, emission: {", {}, "}}}"};
    p["media.density.noise"] = {"media: {x: {scattering: 2, density: {noise: {", {}, "}}}}"};
    p["objects.mesh"] = object("mesh", "chair.obj");
    p["objects.mesh.displacement"] = {
        "objects: {x: {mesh: chair.obj, displacement: {", {{"texture", "marble"}}, "}}}"};
    p["objects.curves"] = object("curves", "fur.hair");
    p["objects.emit"] = {"objects: {x: {shape: sphere, emit: {", {}, "}}}"};
    p["objects.instance"] = object("instance", "tree");
    p["objects.group"] = {"objects: {x: {group: {", {}, "}}}"};
    p["groups"] = {"groups: {x: {", {{"objects", "{a: {shape: disk}}"}}, "}}"};
    p["transform"] = {"objects: {x: {shape: box, transform: [{", {}, "}]}}"};
    p["transform.rotate"] = {"objects: {x: {shape: box, transform: [{rotate: {",
                             {{"axis", "[1, 0, 0]"}, {"angle", "20"}},
                             "}}]}}"};
    p["transform.rotate.quaternion"] = {"objects: {x: {shape: box, transform: [{rotate: {",
                                        {{"quaternion", "[0, 0, 0, 1]"}},
                                        "}}]}}"};
    p["lights"] = named("lights", "point", {});
    p["linking"] = {
        "lights: {x: {type: point, at: [0, 2, 1], power: 30, light_linking: {", {}, "}}}"};
    for (const char* type : {"point", "spot", "sun"}) {
      p[std::string("lights.") + type] = named("lights", type, {});
    }
    p["lights.projector"] = named("lights", "projector", {{"image", "wood.png"}});
    p["color"] = {"color: {", {{"config", "view.ocio"}}, "}"};
    p["outputs"] = {"outputs: [{", {{"file", "image.####.exr"}}, "}]"};
    p["outputs.exr"] = p["outputs"];
    p["outputs.png"] = {"outputs: [{", {{"file", "image.####.png"}}, "}]"};
    p["outputs.jpg"] = {"outputs: [{", {{"file", "image.####.jpg"}}, "}]"};
    p["outputs.tiff"] = {"outputs: [{", {{"file", "image.####.tif"}}, "}]"};
    p["outputs.mp4"] = {"outputs: [{", {{"file", "film.mp4"}}, "}]"};
    p["outputs.webm"] = {"outputs: [{", {{"file", "film.webm"}}, "}]"};
    return p;
  }();
  return all;
}

std::string job_text(const JobKey& id, const Pairs& pairs) {
  std::string text;
  if (id.section == "job") {
    for (const auto& [key, value] : pairs) text.append(key).append(": ").append(value) += "\n";
    return text;
  }
  const Place& place = places().at(id.section);
  text = "hyades: 1\ninclude: base.yaml\n";
  if (id.section != "frames") text += "frames: {range: 1-10, shutter: 0.25}\n";
  if (id.section == "transform" && pairs.empty()) return text + "objects: {x: {shape: box}}\n";
  text += place.before;
  for (size_t i = 0; i < pairs.size(); ++i) {
    text += (i == 0 ? "" : ", ") + pairs[i].first + ": " + pairs[i].second;
  }
  return text + place.after + "\n";
}

Pairs base_pairs(const JobKey& id) {
  if (id.section == "job") return {{"hyades", "1"}, {"include", "base.yaml"}, {"frames", "1-10"}};
  return places().at(id.section).pairs;
}

std::string sample_text(const JobKey& id) {
  Pairs pairs = base_pairs(id);
  const auto needed = company(id);
  if (!needed.empty() &&
      (id.key == "edge" || id.key == "emission_color" || id.key == "diffuse_transmission")) {
    pairs.insert(pairs.end(), needed.begin(), needed.end());
  } else if (id.section == "materials.conductor" && !needed.empty()) {
    pairs.emplace_back("metal", "gold");
  }
  return job_text(id, pairs);
}

Pairs pairs_with(const JobKey& id, const std::optional<std::string>& value) {
  Pairs pairs;
  if (value) pairs.emplace_back(id.key, *value);
  for (const auto& pair : base_pairs(id)) {
    if (!excludes(id, pair.first)) pairs.push_back(pair);
  }
  for (const auto& pair : company(id)) pairs.push_back(pair);
  return pairs;
}

std::string text_with(const JobKey& id, const std::optional<std::string>& value) {
  return job_text(id, pairs_with(id, value));
}

}  // namespace hyades::core
