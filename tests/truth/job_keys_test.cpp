// Every key of a job that is said to decide what is seen does: small pictures with docs/job.md's
// example and without it have other bits. A key that is read and then forgotten would leave them.

#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/geometry/read_hair.h"
#include "core/geometry/read_places.h"
#include "core/image/write_image.h"
#include "tests/core/job/documented_keys.h"
#include "tests/support/temp_folder.h"
#include "tests/support/vdb_writer.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

using core::DocumentedKey;
using core::JobKey;
using core::Pairs;

constexpr const char* kRoomOfKeys = R"yaml(
film: {size: [12, 9]}
sampling: {samples: 8}
camera: {look_from: [0.3, 1.2, 4], look_at: [0, 0.5, 0]}
textures: {marble: {type: fbm3d, octaves: 5}, tiles: {type: checker, scale: 3, a: 0.1}, paint: {type: image, file: wood.png}}
materials:
  clay: {type: lambert, color: 0.3}
  steel: {type: conductor, metal: iron}
  glass: {type: dielectric}
  tiled: {type: lambert, color: tiles}
  air: {type: "null"}
media: {mist: {scattering: 0.1}, milk: {scattering: 5}, neon: {absorption: 1, emission: 1}}
groups: {tree: {objects: {a: {shape: sphere, radius: 0.5}, b: {shape: box, material: clay}}}}
objects:
  ball: {shape: sphere, radius: 0.3, at: ["= t", 0.3, 0.7]}
  floor: {shape: rectangle, size: [9, 9], material: tiled}
lights: {bulb: {type: point, at: [1, 3, 2], power: 50}}
environment: {color: [0.3, 0.2, 0.1]}
)yaml";

/// Squares of which each has another colour and, where there is one, another opacity.
core::Image patches(int width, int height, bool alpha) {
  core::Image image = core::make_image(width, height, {"R", "G", "B"});
  if (alpha) image = core::make_image(width, height, {"R", "G", "B", "A"});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (size_t c = 0; c < image.channels.size(); ++c)
        image.at(x, y, static_cast<int>(c)) =
            0.1F + 0.1F * static_cast<float>((3 * x + 5 * y + 7 * c) % 9);
    }
  }
  return image;
}

/// A pyramid over a square, of two materials, with texture coordinates, and with colours in PLY.
constexpr const char* kChair = R"obj(
v -0.7 0 -0.7
v 0.7 0 -0.7
v 0.7 0 0.7
v -0.7 0 0.7
v 0 1.2 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vt 0.5 0.5
usemtl wood
f 4/4 3/3 5/5
f 3/3 2/2 5/5
usemtl glass
f 2/2 1/1 5/5
f 1/1 4/4 5/5
f 1/1 2/2 3/3
f 1/1 3/3 4/4
)obj";

constexpr const char* kKnot = R"ply(ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
property float s
property float t
property float red
property float green
property float blue
property float alpha
element face 6
property list uchar int vertex_indices
end_header
-0.7 0 -0.7 0 0 1 0.2 0.1 0.9
0.7 0 -0.7 1 0 0.2 1 0.1 0.7
0.7 0 0.7 1 1 0.2 0.1 1 0.5
-0.7 0 0.7 0 1 0.9 0.8 0.1 0.3
0 1.2 0 0.5 0.5 0.5 0.5 0.5 0.1
3 3 2 4
3 2 1 4
3 1 0 4
3 0 3 4
3 0 1 2
3 0 2 3
)ply";

/// What the page's examples name.
std::string folder_of_examples() {
  static const TempFolder folder;
  static const bool made = [] {
    const auto write = [](const std::string& name, std::string_view bytes) {
      std::ofstream(folder.file(name), std::ios::binary)
          .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    };
    write("base.yaml", kRoomOfKeys);
    write("sky.yaml", "environment: {color: 0.3}\n");
    write("knot.ply", kKnot);
    write("chair.obj", kChair);
    core::StrandList strands;
    for (int s = 0; s < 9; ++s) {
      for (int i = 0; i < 7; ++i) {
        const float along = 0.2F * static_cast<float>(i);
        strands.points.emplace_back(0.15F * static_cast<float>(s - 4) + 0.2F * along * along, along,
                                    0.3F * along * static_cast<float>(i % 2));
        strands.radii.push_back(0.05F);
      }
      strands.sizes.push_back(7);
    }
    const core::Bytes fur = core::hair_bytes(strands);
    write("fur.hair", {fur.chars(), fur.size()});
    EXPECT_TRUE(core::write_png(folder.file("wood.png"), patches(8, 8, true)).ok());
    EXPECT_TRUE(core::write_png(folder.file("bricks.png"), patches(6, 4, false)).ok());
    EXPECT_TRUE(core::write_exr(folder.file("sky.hdr"), patches(16, 8, false)).ok());
    write("forest.ply",
          "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
          "float z\nend_header\n"
          "-0.6 0.2 0\n0.6 0.4 0\n");
    const auto numbers = [](const char* name, double scale) {
      return vdb_box<openvdb::FloatGrid>(
          name, 8, 0.2, {-0.8, -0.4, -0.8}, [&](int i, int j, int k) {
            return static_cast<float>(scale * (1.0 + (i + 2 * j + 3 * k) % 5));
          });
    };
    const auto colours =
        vdb_box<openvdb::Vec3SGrid>("Cd", 8, 0.2, {-0.8, -0.4, -0.8}, [](int i, int j, int k) {
          return openvdb::Vec3s(0.2F * static_cast<float>(i % 5), 0.2F * static_cast<float>(j % 5),
                                0.1F * static_cast<float>(k));
        });
    for (const char* name : {"smoke.vdb", "cloud.vdb"}) {
      write(name, vdb_file({numbers("density", name[0] == 's' ? 0.5 : 0.8), numbers("smoke", 1.5),
                            numbers("flames", 0.2), numbers("temperature", 0.25),
                            numbers("heat", 0.4), colours}));
    }
    return true;
  }();
  EXPECT_TRUE(made);
  return folder.path().string();
}

bool starts(const std::string& text, const char* with) { return text.starts_with(with); }

constexpr const char* kChairOfX =
    "objects: {s: {mesh: chair.obj, material: x, transform: [{rotate_y: 20}]}}\n";
/// Its back is towards the camera.
constexpr const char* kBackOfX =
    "objects: {s: {shape: rectangle, material: x, transform: [{rotate_x: -90}], at: [0, 0.7, "
    "0]}}\n";
constexpr const char* kGlowingX =
    "objects: {s: {shape: sphere, radius: 0.7, at: [0, 0.8, 0], material: x, interior: neon}}\n";

/// What shows the `x` of a section.
std::string stage_for(const JobKey& id) {
  const std::string& section = id.section;
  if (id.key == "sides" || section == "materials.two-sided") return kBackOfX;
  if (id.key == "scale_radiance") return kGlowingX;
  if (section == "materials.hair") return "objects: {s: {curves: fur.hair, material: x}}\n";
  if (starts(section, "materials")) return kChairOfX;
  if (starts(section, "textures")) {
    return "materials: {shown: {type: lambert, color: x}}\n"
           "objects: {s: {mesh: knot.ply, material: shown, transform: [{rotate_y: 20}]}}\n";
  }
  if (starts(section, "media")) {
    const std::string material = id.key == "index" ? "" : ", material: air";
    const std::string radius = starts(section, "media.density.shell") ? "1.6" : "0.8";
    return "objects: {s: {shape: sphere, at: [0, 0.8, 0], radius: " + radius + ", interior: x" +
           material + "}}\n";
  }
  if (starts(section, "groups")) return "objects: {s: {instance: x}}\n";
  return "";
}

/// What makes a key seen: keys beside it, a value in place of the page's example where that would
/// need a larger picture, and one to compare with where there must be some.
struct Trial {
  Pairs beside = {};
  std::string value = {};
  std::string other = {};
};
Trial trial_of(const JobKey& id) {
  const std::string& section = id.section;
  const std::string& key = id.key;
  const auto one_of = [&](std::initializer_list<const char*> keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  if (starts(section, "integrator.") && one_of({"max_depth", "roulette_depth"}))
    return {.value = "1"};
  if (section == "integrator.path" && key == "clamp") return {.value = "0.01"};
  if (starts(section, "camera.") && key == "focus") return {{{"aperture", "{radius: 0.1}"}}};
  if (section == "camera.aperture" && key == "blades") return {{{"radius", "0.3"}}};
  if (section == "camera.aperture" && key == "rotation")
    return {{{"radius", "0.3"}, {"blades", "3"}}};
  if (section == "textures.checker" && key == "b") return {{{"scale", "5"}}};
  if (section == "textures.brick" && key == "shift") return {{{"scale", "5"}}};
  if (starts(section, "textures.perlin") && one_of({"lacunarity", "gain"}))
    return {{{"octaves", "3"}}};
  if (section == "textures.ramp" && key == "between") return {{{"input", "marble"}}};
  if (section == "textures.hue-saturation" && key != "input") return {{{"input", "paint"}}};
  if (section == "media.density.shell" && one_of({"scale", "octaves", "time"}))
    return {{{"swirl", "0.3"}}};
  if (section == "materials.conductor" && key == "eta") return {.other = "[1.5, 0.9, 0.3]"};
  if (section == "materials.conductor" && key == "k") return {.other = "[1, 2, 3]"};
  if (section == "media" && key == "albedo") return {.other = "0.3"};
  if (section == "media" && key == "density") return {.other = "1"};
  if (section == "media" && key == "mean_free_path") return {.other = "0.5"};
  if (section == "materials.principled") {
    if (key == "anisotropic_rotation") return {{{"metallic", "1"}, {"anisotropic", "0.8"}}};
    if (starts(key, "coat_")) return {{{"coat", "1"}}};
    if (starts(key, "sheen_")) return {{{"sheen", "1"}}};
    if (one_of({"thin_walled", "scale_radiance"})) return {{{"transmission", "1"}}};
    if (key == "multiple_scattering") return {{{"metallic", "1"}, {"roughness", "0.8"}}};
  }
  if (section == "materials.glossy" && key == "multiple_scattering")
    return {{{"glossiness", "0.2"}}};
  if (starts(section, "materials.") && key == "multiple_scattering")
    return {{{"roughness", "0.8"}}};
  if (section == "media" && one_of({"phase", "g", "g2", "blend", "scale", "emission", "index"})) {
    Pairs beside = {{"scattering", "2"}};
    if (one_of({"g2", "blend"})) beside.emplace_back("g", "0.7");
    if (key == "g2") beside.emplace_back("blend", "0.4");
    if (key == "blend") beside.emplace_back("g2", "-0.3");
    return {beside};
  }
  if (section == "objects" && key == "group") return {.value = "{objects: {a: {shape: box}}}"};
  if (section == "objects" && key == "override") return {{{"material", "clay"}}};
  if (section == "objects.bodies" && key == "interior") return {{{"material", "glass"}}};
  if (section == "lights.spot" || section == "lights.projector") {
    return {
        {{"at", "[1, 3, 2]"}, {"look_at", "[0, 0.5, 0]"}}, "", key == "image" ? "wood.png" : ""};
  }
  if (section == "lights" && key == "shadow_linking")
    return {{{"at", "[0.3, 2, 0.7]"}, {"power", "90"}}};
  if (section == "environment" && key == "rotate_y") return {{{"image", "sky.hdr"}}};
  return {};
}

/// Keys that decide something else than a film's pixels, or not in so small a picture; what nested
/// bodies and importers make of theirs is tested with them.
bool is_seen_elsewhere(const JobKey& id) {
  const auto is = [&](const char* section, std::initializer_list<const char*> keys) {
    return id.section == section &&
           (keys.size() == 0 || std::find(keys.begin(), keys.end(), id.key) != keys.end());
  };
  if (id.section == "job") return id.key != "units" && id.key != "atmosphere";  // of what they hold
  if (id.section == "color" || starts(id.section, "outputs")) return true;
  return id.key == "light_group" ||                                 // of layers of their own
         is("animation", {"repeat"}) || is("frames", {"range"}) ||  // of other frames
         is("sampling", {"noise", "min_samples"}) ||                // of rounds
         is("render", {"class"}) ||                                 // of who renders
         starts(id.section, "camera.exposure") ||
         is("camera", {"exposure"}) ||                                   // of what is written
         is("objects", {"gltf", "pbrt", "obj", "animation", "loop"}) ||  // of importers
         is("objects.bodies", {"exterior", "priority"}) ||               // of bodies that meet
         is("objects.mesh.displacement", {"budget"});                    // a limit
}

/// The film's pixels, or why there are none.
std::string picture_of(const std::string& text) {
  try {
    const YamlScene scene(text, 5, {}, folder_of_examples());
    const core::Image picture = scene.render().film.normalised();
    return {reinterpret_cast<const char*>(picture.data.data()),
            picture.data.size() * sizeof(float)};
  } catch (const std::exception& error) {
    return std::string("error: ") + error.what();
  }
}

/// The job in which `id` has `value`, or has none, where it is seen.
std::string shown(const JobKey& id, const std::optional<std::string>& value) {
  Pairs pairs = core::pairs_with(id, value);
  for (const auto& pair : trial_of(id).beside) {
    const auto same = [&](const auto& other) { return other.first == pair.first; };
    if (pair.first == id.key) continue;
    std::erase_if(pairs, same);
    pairs.push_back(pair);
  }
  return core::job_text(id, pairs);
}

/// `text` with the room's stage for `id`.
std::string staged(const JobKey& id, std::string text) {
  std::ofstream(folder_of_examples() + "/stage.yaml") << "hyades: 1\n" << stage_for(id);
  const std::string include = "include: base.yaml\n";
  if (text.find(include) == std::string::npos) ADD_FAILURE() << text;
  if (id.section == "objects.emit" && id.key == "two_sided")
    text.replace(text.find("shape: sphere"), 13,
                 "shape: rectangle, transform: [{rotate_x: -90}], at: [0, 0.7, 0]");
  return text.replace(text.find(include), include.size(), "include: [base.yaml, stage.yaml]\n");
}

/// A picture to compare with: of the job without the key; or, where there must be one, with another
/// value of it and all else as it is.
std::string other_picture(const JobKey& id, std::map<std::string, std::string>& known) {
  std::optional<std::string> other;
  for (const auto& [key, value] : core::base_pairs(id)) {
    if (key == id.key) other = value;
  }
  if (const std::string said = trial_of(id).other; !said.empty()) other = said;
  const std::string text = staged(id, shown(id, other));
  std::string& picture = known[text + stage_for(id)];  // which many keys of a section share
  if (picture.empty()) picture = picture_of(text);
  const bool is_what_there_is =
      id.section == "objects" || id.section == "media.density" || id.key == "like";
  if (!starts(picture, "error: ") || !is_what_there_is) return picture;
  return picture_of(staged(id, core::sample_text(id)));
}

TEST(JobKeys, DecideWhatIsSeen) {
  int tried = 0;
  std::map<std::string, std::string> known;
  for (const DocumentedKey& key : core::read_page()) {
    const JobKey& id = key.id;
    if (is_seen_elsewhere(id)) continue;
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + id.section + " / " + id.key);
    const std::string value = trial_of(id).value;
    const std::string with = staged(id, shown(id, value.empty() ? key.example : value));
    const std::string changed = picture_of(with);
    const std::string other = other_picture(id, known);
    EXPECT_FALSE(starts(other, "error: ")) << other;
    EXPECT_FALSE(starts(changed, "error: ")) << changed << "\n" << with;
    EXPECT_FALSE(other == changed) << "is not seen:\n" << with;
    ++tried;
  }
  EXPECT_GT(tried, 350);
}

}  // namespace
}  // namespace hyades::test
