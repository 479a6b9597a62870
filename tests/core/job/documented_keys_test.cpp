#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "core/job/job_keys.h"
#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "core/job/scene_document.h"
#include "tests/core/job/test_assets.h"

/// Holds docs/job.md against the reader: every key that the reader knows is documented and the
/// other way round, every example is accepted and changes the render key or what is written, and
/// every default is what happens without the key.
namespace hyades::core {
namespace {

struct DocumentedKey {
  JobKey id;
  std::string type;
  std::string default_value;  ///< YAML; empty where the page names none
  bool required = false;
  std::string example;  ///< YAML
  int line = 0;
};

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

using Pairs = std::vector<std::pair<std::string, std::string>>;

/// A place in a job where the keys of one section are tried: `before` {pairs} `after`.
struct Place {
  std::string before;
  Pairs pairs;  ///< what must be there besides the key that is tried
  std::string after;
};

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

constexpr const char* kBase = R"yaml(
textures: {marble: {type: fbm3d, octaves: 5}, tiles: {type: checker, scale: 3}}
materials: {clay: {type: lambert, color: 0.3}, steel: {type: conductor, metal: iron}}
media: {mist: {scattering: 0.1}, milk: {scattering: 5}}
groups: {tree: {objects: {a: {shape: sphere}, b: {shape: box}}}}
objects: {ball: {shape: sphere, radius: 3, at: ["= t", 0, 0]}}
lights: {bulb: {type: point, power: 5}}
)yaml";

/// The text of a job in which the section of `id` holds `pairs`.
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

struct Outcome {
  std::string complaints;
  std::string fingerprint;
  int moving = 0;  ///< values that are no constants
};

/// What importers would make of scenes of other tools.
void add_scenes(MemoryAssets& assets) {
  for (const char* scene : {"robot.glb", "room.pbrt", "chair.obj"}) {
    for (const char* animation : {"", "Walk"}) {
      const std::string shape = *animation != '\0' ? "box" : "sphere";
      assets.add(reference_of({scene, "x", 24.0F, animation}),
                 "objects: {x." + std::string(1, *scene) + ": {shape: " + shape + "}}\n");
    }
    assets.add(reference_of({scene, "x", 24.0F, "", true}), "objects: {x.o: {shape: disk}}\n");
  }
}

/// Everything that decides pixels, and everything else that a job says about what is written.
Outcome outcome_of(const std::string& text) {
  MemoryAssets inner;
  inner.add("base.yaml", kBase);
  inner.add("sky.yaml", "environment: {color: 0.3}\n");
  for (const char* file :
       {"knot.ply", "forest.ply", "fur.hair", "chair.obj", "wood.png", "bricks.png", "sky.hdr",
        "smoke.vdb", "cloud.vdb", "aces/config.ocio", "view.ocio"}) {
    inner.add(file, std::string("content of ") + file);
  }
  add_scenes(inner);
  RecordingResolver assets(inner);
  Diagnostics diagnostics;
  const Job job = parse_job(text, "sample.yaml", assets, diagnostics);
  Outcome outcome;
  outcome.complaints = diagnostics.to_string();
  if (!diagnostics.empty()) return outcome;
  std::stringstream all;
  for (const int32_t frame : {job.frames.first, job.frames.first + 4, job.frames.last}) {
    all << render_key(job, frame, assets.records()) << "\n";
  }
  if (job.film.crop) all << job.film.crop->x0 << " " << job.film.crop->y1 << " ";
  all << job.name << " " << job.keep_films << " " << job.frames.first << " " << job.frames.last
      << " " << job.frames.step;
  for (const OutputDesc& output : job.outputs) {
    all << "\n"
        << output.file << " " << output.tone_map << " " << output.exposure << " " << output.half
        << " " << output.transparent << " " << output.denoise << " " << output.jpeg_quality << " "
        << output.bits;
    for (const std::string& layer : output.layers) all << " " << layer;
  }
  if (const auto& color = job.color) {
    all << "\n"
        << color->config << " " << color->display << " " << color->view << " " << color->look << " "
        << color->working_space;
  }
  for (const VideoDesc& video : job.videos) all << "\n" << video.file << " " << video.rate_factor;
  outcome.fingerprint = all.str();
  for (const Curve& curve : job.curves) {
    const auto constant = [](const auto& value) { return value.is_constant(); };
    if (!std::visit(constant, curve.value)) ++outcome.moving;
  }
  return outcome;
}

Pairs base_pairs(const JobKey& id) {
  if (id.section == "job") return {{"hyades", "1"}, {"include", "base.yaml"}, {"frames", "1-10"}};
  return places().at(id.section).pairs;
}

/// The sample job as it is before the key is tried.
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

/// The sample job with `value` for the key, or without the key, in place of whatever it excludes.
std::string text_with(const JobKey& id, const std::optional<std::string>& value) {
  Pairs pairs;
  if (value) pairs.emplace_back(id.key, *value);
  for (const auto& pair : base_pairs(id)) {
    if (!excludes(id, pair.first)) pairs.push_back(pair);
  }
  for (const auto& pair : company(id)) pairs.push_back(pair);
  return job_text(id, pairs);
}

/// Keys whose range has one value in this version: any other one must be refused.
bool has_one_value(const JobKey& id) { return id == JobKey{"job", "hyades"}; }

TEST(DocumentedKeys, AreThoseThatTheReaderKnows) {
  std::set<JobKey> documented;
  for (const DocumentedKey& key : read_page()) {
    EXPECT_TRUE(documented.insert(key.id).second)
        << key.id.section << " / " << key.id.key << " is documented twice";
  }
  const std::set<JobKey> known = known_job_keys();
  for (const JobKey& id : known) {
    EXPECT_TRUE(documented.contains(id)) << "not in docs/job.md: " << id.section << " / " << id.key;
  }
  for (const JobKey& id : documented) {
    EXPECT_TRUE(known.contains(id))
        << "the reader never asks for " << id.section << " / " << id.key;
  }
  EXPECT_GT(known.size(), 150U);
}

TEST(DocumentedKeys, EveryExampleIsAcceptedAndChangesSomething) {
  for (const DocumentedKey& key : read_page()) {
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    ASSERT_FALSE(key.example.empty());
    const std::string with = text_with(key.id, key.example);
    const Outcome changed = outcome_of(with);
    EXPECT_EQ(changed.complaints, "") << with;
    if (has_one_value(key.id)) {
      EXPECT_NE(outcome_of(text_with(key.id, "other")).complaints, "");
      continue;
    }
    const std::string without = sample_text(key.id);
    const Outcome plain = outcome_of(without);
    EXPECT_EQ(plain.complaints, "") << without;
    EXPECT_NE(plain.fingerprint, changed.fingerprint) << without << "\n" << with;
  }
}

TEST(DocumentedKeys, DefaultsAreWhatHappensWithoutTheKey) {
  int checked = 0;
  for (const DocumentedKey& key : read_page()) {
    if (key.default_value.empty()) continue;
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    const std::string with = text_with(key.id, key.default_value);
    const Outcome spelled_out = outcome_of(with);
    EXPECT_EQ(spelled_out.complaints, "") << with;
    const std::string absent = text_with(key.id, std::nullopt);
    const Outcome silent = outcome_of(absent);
    EXPECT_EQ(silent.complaints, "") << absent;
    EXPECT_EQ(spelled_out.fingerprint, silent.fingerprint) << absent << "\n" << with;
    ++checked;
  }
  EXPECT_GT(checked, 80);
}

TEST(DocumentedKeys, WithoutAValueAreOneComplaintWithItsPlace) {
  for (const DocumentedKey& key : read_page()) {
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    Pairs pairs = base_pairs(key.id);
    pairs.emplace_back("like", "");
    const std::string text = key.id.key == "like" ? job_text(key.id, pairs) : text_with(key.id, "");
    const std::string complaints = outcome_of(text).complaints;
    EXPECT_TRUE(complaints.starts_with("sample.yaml:")) << complaints << "\n" << text;
    EXPECT_THAT(complaints, testing::HasSubstr(key.id.key));
    EXPECT_LE(std::count(complaints.begin(), complaints.end(), '\n'), 1) << complaints << "\n"
                                                                         << text;
  }
}

/// What one key asks of another must not trip over one that is empty.
TEST(DocumentedKeys, WithoutAValueAreComplaintsBesideAnyOther) {
  const std::vector<DocumentedKey> all = read_page();
  for (const DocumentedKey& key : all) {
    for (const DocumentedKey& other : all) {
      if (other.id.section != key.id.section || other.id.key == key.id.key) continue;
      Pairs pairs = {{key.id.key, ""}, {other.id.key, other.example}};
      for (const auto& pair : base_pairs(key.id)) {
        if (pair.first != key.id.key && pair.first != other.id.key) pairs.push_back(pair);
      }
      EXPECT_THAT(outcome_of(job_text(key.id, pairs)).complaints,
                  testing::HasSubstr("sample.yaml:"))
          << job_text(key.id, pairs);
    }
  }
  for (const char* text :
       {"hyades: 1\ncolor: {config: view.ocio}\noutputs: [{file: a.png, tone_map: }]\n",
        "hyades: 1\ntextures: {x: {type: image, file: a.<UDIM>.png, wrap: }}\n"}) {
    EXPECT_THAT(outcome_of(text).complaints, testing::HasSubstr("is empty, expected a value"));
  }
}

/// A plain value of the key, to be given at two frames; empty where the page has names and
/// expressions only.
std::string value_to_keep(const DocumentedKey& key) {
  for (const std::string& value : {key.example, key.default_value}) {
    if (value.empty() || value.find("keys") != std::string::npos ||
        value.find("\"=") != std::string::npos)
      continue;
    if (std::string("[-.0123456789").find(value[0]) != std::string::npos) return value;
  }
  return "";
}

TEST(DocumentedKeys, WhatIsSaidToBeAnimatedFollowsKeys) {
  int checked = 0;
  for (const DocumentedKey& key : read_page()) {
    const bool animated = key.type.find("animated") != std::string::npos ||
                          key.type.find("or texture") != std::string::npos;
    const std::string value = value_to_keep(key);
    if (!animated || value.empty()) continue;
    const std::string keyed =
        text_with(key.id, "{keys: {1: " + value + ", 10: " + value + "}, ease: smooth}");
    const Outcome still = outcome_of(text_with(key.id, value));
    const Outcome moving = outcome_of(keyed);
    EXPECT_EQ(moving.complaints, "") << "docs/job.md:" << key.line << "\n" << keyed;
    EXPECT_EQ(moving.moving, still.moving + 1) << "docs/job.md:" << key.line << "\n" << keyed;
    ++checked;
  }
  EXPECT_GT(checked, 150);
}

TEST(DocumentedKeys, RequiredKeysAreRequired) {
  for (const DocumentedKey& key : read_page()) {
    if (!key.required) continue;
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    Pairs pairs = key.id.section == "job" ? Pairs{{"include", "base.yaml"}}
                                          : places().at(key.id.section).pairs;
    std::erase_if(pairs, [&](const auto& pair) { return pair.first == key.id.key; });
    EXPECT_NE(outcome_of(job_text(key.id, pairs)).complaints, "");
  }
}

}  // namespace
}  // namespace hyades::core
