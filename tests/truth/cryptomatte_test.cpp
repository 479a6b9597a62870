// Ids and their Cryptomatte: a decoder written from the specification (version 1.2.0) finds the
// masks of a scene whose coverage is known, and no tiling or order changes a bit.

#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "core/film/film_codec.h"
#include "core/finish/frame_outputs.h"
#include "core/job/layers.h"
#include "core/samplers/filter.h"
#include "tests/support/temp_folder.h"
#include "tests/truth/render_yaml.h"

namespace hyades::test {
namespace {

// One pixel is one unit wide in the plane z = 0.
const std::string kPlates = R"yaml(
hyades: 1
name: plates
film: {size: [16, 8], filter: box}
sampling: {samples: 256}
integrator: {type: path, max_depth: 1}
camera: {look_from: [0, 0, 10], look_at: [0, 0, 0], fov: 43.602819}
materials:
  red: {type: lambert, color: [0.8, 0.1, 0.1]}
  glass: {type: dielectric, ior: 1.5}
  leaf: {type: lambert, color: 0.5, opacity: 0.25}
objects:
  left: {shape: rectangle, size: [8.25, 40], transform: [{rotate_x: 90}], at: [-3.875, 0, 0], material: red}
  plates:
    group: {objects: {
      right: {shape: rectangle, size: [3.75, 40], transform: [{rotate_x: 90}], at: [2.125, 0, 0], material: red}}}
  pane: {shape: rectangle, size: [1.6, 20], transform: [{rotate_x: 90}], at: [-5.6, 0, 2], material: glass}
  leaf: {shape: rectangle, size: [1.8, 20], transform: [{rotate_x: 90}], at: [2.7, 0, 1], material: leaf}
outputs:
  - {file: plates.exr, layers: [beauty, crypto_object, crypto_material, object_id], half: true}
)yaml";

/// A file's channels as floats, and its text attributes.
struct Exr {
  int width = 0;
  int height = 0;
  std::map<std::string, std::vector<float>> channels;
  std::map<std::string, std::string> texts;
  std::map<std::string, Imf::PixelType> types;
};

Exr read_exr(const std::string& path) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i box = file.header().dataWindow();
  Exr exr;
  exr.width = box.max.x - box.min.x + 1;
  exr.height = box.max.y - box.min.y + 1;
  Imf::FrameBuffer buffer;
  const Imf::ChannelList& channels = file.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    auto& values = exr.channels[c.name()];
    values.resize(static_cast<size_t>(exr.width * exr.height));
    exr.types[c.name()] = c.channel().type;
    buffer.insert(c.name(),
                  Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                             sizeof(float) * static_cast<size_t>(exr.width)));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(box.min.y, box.max.y);
  for (auto a = file.header().begin(); a != file.header().end(); ++a) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
      exr.texts[a.name()] = text->value();
  }
  return exr;
}

/// As the specification's reference has it.
uint32_t murmur3(const std::string& key) {
  const auto rotl = [](uint32_t x, int r) { return (x << r) | (x >> (32 - r)); };
  uint32_t h = 0;
  const auto* data = reinterpret_cast<const uint8_t*>(key.data());
  const size_t blocks = key.size() / 4;
  for (size_t i = 0; i < blocks; ++i) {
    uint32_t k = 0;
    std::memcpy(&k, data + 4 * i, 4);
    k *= 0xcc9e2d51;
    k = rotl(k, 15) * 0x1b873593;
    h = rotl(h ^ k, 13) * 5 + 0xe6546b64;
  }
  const uint8_t* tail = data + 4 * blocks;
  uint32_t k = 0;
  switch (key.size() & 3U) {
    case 3:
      k ^= static_cast<uint32_t>(tail[2]) << 16;
      [[fallthrough]];
    case 2:
      k ^= static_cast<uint32_t>(tail[1]) << 8;
      [[fallthrough]];
    case 1:
      k ^= tail[0];
      k *= 0xcc9e2d51;
      h ^= rotl(k, 15) * 0x1b873593;
  }
  h ^= static_cast<uint32_t>(key.size());
  h ^= h >> 16;
  h *= 0x85ebca6b;
  h ^= h >> 13;
  h *= 0xc2b2ae35;
  return h ^ (h >> 16);
}

float float_id(const std::string& name) {
  uint32_t hash = murmur3(name);
  const uint32_t exponent = hash >> 23 & 255;
  if (exponent == 0 || exponent == 255) hash ^= 1U << 23;
  float id = 0.0F;
  std::memcpy(&id, &hash, 4);
  return id;
}

/// The mask of `name` in the Cryptomatte `layer` of a file: found by its metadata, matched by id.
std::vector<float> mask(const Exr& exr, const std::string& layer, const std::string& name) {
  std::string prefix;
  for (const auto& [key, value] : exr.texts) {
    if (key.starts_with("cryptomatte/") && key.ends_with("/name") && value == layer)
      prefix = key.substr(0, key.size() - 4);
  }
  if (prefix.empty()) return {};
  EXPECT_EQ(prefix.size(), std::string("cryptomatte/0123456/").size());
  EXPECT_EQ(exr.texts.at(prefix + "hash"), "MurmurHash3_32");
  EXPECT_EQ(exr.texts.at(prefix + "conversion"), "uint32_to_float32");
  const float id = float_id(name);
  uint32_t bits = 0;
  std::memcpy(&bits, &id, 4);
  char hex[16];
  std::snprintf(hex, sizeof hex, "%08x", bits);
  const std::string entry = "\"" + name + "\":\"" + hex + "\"";
  EXPECT_NE(exr.texts.at(prefix + "manifest").find(entry), std::string::npos)
      << entry << " in " << exr.texts.at(prefix + "manifest");
  std::vector<float> found(static_cast<size_t>(exr.width * exr.height));
  for (const char* level : {"00", "01", "02"}) {
    for (const auto& [id_channel, coverage_channel] :
         {std::pair(".R", ".G"), std::pair(".B", ".A")}) {
      const auto& ids = exr.channels.at(layer + level + id_channel);
      const auto& coverage = exr.channels.at(layer + level + coverage_channel);
      EXPECT_EQ(exr.types.at(layer + level + id_channel), Imf::FLOAT);
      for (size_t i = 0; i < found.size(); ++i) {
        if (std::memcmp(&ids[i], &id, 4) == 0) found[i] += coverage[i];
      }
    }
  }
  return found;
}

class Cryptomatte : public ::testing::Test {
 protected:
  Exr written(const std::string& yaml) {
    const YamlScene job_only(yaml);
    const YamlScene scene(yaml, 1, core::needed_layers(job_only.job()));
    film_ = scene.render().film;
    core::FilmInfo info;
    info.frame = 1;
    info.width = 16;
    info.height = 8;
    const auto paths =
        core::write_outputs(scene.job().outputs, folder_.path().string(), info, film_);
    EXPECT_TRUE(paths.ok()) << paths.error().message;
    return read_exr((*paths)[0]);
  }

  TempFolder folder_;
  core::Film film_;
};

TEST_F(Cryptomatte, MasksAreWhatCoversThePixels) {
  const Exr exr = written(kPlates);
  EXPECT_EQ(exr.types.at("R"), Imf::HALF);
  const std::vector<float> left = mask(exr, "CryptoObject", "left");
  const std::vector<float> right = mask(exr, "CryptoObject", "plates/right");
  const std::vector<float> pane = mask(exr, "CryptoObject", "pane");
  const std::vector<float> leaf = mask(exr, "CryptoObject", "leaf");
  const std::vector<float> red = mask(exr, "CryptoMaterial", "red");
  ASSERT_FALSE(left.empty());
  // By columns: the pane hides -8..-6 of the left plate (it stands nearer, so is seen wider), the
  // leaf a quarter of 2..4 of the right one.
  const float nothing = 0.0F;
  for (size_t row = 0; row < 8; ++row) {
    const auto at = [&](const std::vector<float>& m, size_t column) {
      return m[row * 16 + column];
    };
    EXPECT_EQ(at(pane, 0), 1.0F);
    EXPECT_EQ(at(left, 0), nothing);
    for (size_t x = 2; x < 8; ++x) EXPECT_EQ(at(left, x), 1.0F) << x;
    EXPECT_NEAR(at(left, 8), 0.25F, 0.01F);
    EXPECT_NEAR(at(right, 8), 0.75F, 0.01F);
    EXPECT_EQ(at(red, 8), 1.0F);
    EXPECT_EQ(at(right, 9), 1.0F);
    EXPECT_NEAR(at(leaf, 10), 0.25F, 0.09F);  // 3 standard deviations of 256 samples
    EXPECT_EQ(at(leaf, 10) + at(right, 10), 1.0F);
    EXPECT_EQ(at(red, 10), at(right, 10));
    for (size_t x = 12; x < 16; ++x) {
      EXPECT_EQ(at(right, x) + at(left, x) + at(red, x), nothing) << x;
    }
    const float id = float_id("left");
    EXPECT_EQ(std::memcmp(&exr.channels.at("object_id.ID")[row * 16 + 5], &id, 4), 0);
    EXPECT_EQ(exr.channels.at("object_id.ID")[row * 16 + 14], 0.0F);
  }
}

TEST_F(Cryptomatte, FiltersWithNegativeLobesCountWhatTheyAdd) {
  std::string text = kPlates;
  text.replace(text.find("filter: box"), 11, "filter: {type: mitchell, radius: 2}");
  const Exr exr = written(text);
  const std::vector<float> left = mask(exr, "CryptoObject", "left");
  const std::vector<float> right = mask(exr, "CryptoObject", "plates/right");
  for (size_t i = 0; i < left.size(); ++i) {
    EXPECT_GE(left[i], 0.0F);
    EXPECT_LE(left[i] + right[i], 1.0F);
  }
  EXPECT_EQ(left[5], 1.0F);
  EXPECT_EQ(right[5], 0.0F);
  // The plates meet at 8.25: what the filter of each pixel, where it is positive, has beyond that.
  const auto filter = core::make_pixel_filter(core::FilterShape::mitchell, 2.0F);
  for (const size_t column : {6U, 7U, 8U}) {
    double all[2] = {0.0, 0.0};  // positive and negative parts along one axis
    double beyond[2] = {0.0, 0.0};
    for (int i = 0; i < 4000; ++i) {
      const double x = (i + 0.5) / 1000.0 - 2.0;
      const auto f = static_cast<double>(filter->evaluate_along(static_cast<float>(x)));
      const size_t sign = f < 0.0 ? 1 : 0;
      all[sign] += f;
      if (static_cast<double>(column) + 0.5 + x > 8.25) beyond[sign] += f;
    }
    const double expected =
        (beyond[0] * all[0] + beyond[1] * all[1]) / (all[0] * all[0] + all[1] * all[1]);
    double found = 0.0;
    for (size_t row = 0; row < 8; ++row) found += static_cast<double>(right[row * 16 + column]) / 8;
    EXPECT_NEAR(found, expected, 0.006) << "column " << column;
  }
}

TEST_F(Cryptomatte, IdsAreTheSameForAnyTilesBatchesAndIntegrators) {
  const core::LayerSet layers{.ids = {true, true}};
  const YamlScene scene(kPlates, 1, layers);
  const core::Film whole = scene.render().film;
  core::Film pieces(whole.layout(), whole.window());
  std::vector<core::Unit> units;
  for (const uint32_t batch : {5U, 0U, 9U}) {
    const core::BatchRange batches{batch, batch == 5 ? 4U : (batch == 0 ? 5U : 7U)};
    for (const core::PixelRect& tile :
         {core::PixelRect{7, 3, 16, 8}, {0, 0, 16, 3}, {0, 3, 7, 8}}) {
      units.push_back({1, tile, batches});
    }
  }
  for (const core::Unit& unit : units) {
    // As it travels over the wire.
    const auto film = core::decode_film(core::encode_film(scene.renderer().render(unit).film));
    ASSERT_TRUE(film.ok()) << film.error().message;
    ASSERT_TRUE(pieces.merge(*film).ok());
  }
  EXPECT_EQ(pieces.digest(), whole.digest());
  for (const char* integrator : {"bdpt", "mlt"}) {
    std::string text = kPlates;
    text.replace(text.find("type: path"), 10, std::string("type: ") + integrator);
    const core::Film other = YamlScene(text, 1, layers).render().film;
    for (const core::IdKind kind : {core::IdKind::object, core::IdKind::material})
      EXPECT_EQ(other.ids(kind).digest(), whole.ids(kind).digest()) << integrator;
  }
}

}  // namespace
}  // namespace hyades::test
