#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "core/film/film_codec.h"
#include "core/film/film_exr.h"
#include "tests/core/film/film_testing.h"

// Films that hold parts of light, ids and all other layers: the same bits in any order, and back
// from bytes and files.

namespace hyades::core {
namespace {

const PixelRect kRegion{4, 2, 60, 40};

LayerSet every_layer(bool splats) {
  LayerSet layers{true, true, true, splats};
  layers.position = layers.motion = true;
  layers.components.fill(true);
  layers.light_groups = {"key", "rest"};
  layers.ids = {true, true};
  return layers;
}

/// Samples of a few objects, more of them the further right.
void add_ids(Film& film, BatchRange batches) {
  const PixelRect& w = film.window();
  for (const IdKind kind : {IdKind::object, IdKind::material}) {
    IdLayer& ids = film.mutable_ids(kind);
    std::vector<IdCount> counts;
    for (uint32_t pixel = 0; pixel < w.area(); ++pixel) {
      const int x = w.x0 + static_cast<int>(pixel) % w.width();
      for (uint32_t id = 0; id < 1 + static_cast<uint32_t>(x) % 5; ++id) {
        counts.push_back({pixel, 7 * id, batches.count});
        counts.push_back({pixel, 7 * id, 1});
        if (id > 0) ids.name(7 * id, "object " + std::to_string(id));
      }
    }
    std::reverse(counts.begin(), counts.end());
    ids.deposit(std::move(counts));
  }
}

Film part_of(bool splats, const PixelRect& window, BatchRange batches) {
  const FilmLayout layout = make_film_layout(every_layer(splats));
  Film film = splats ? render_with_splats(layout, window, batches, kRegion, 200)
                     : render(layout, window, batches, 200);
  add_ids(film, batches);
  for (size_t part = 0; splats && part < layout.part_count(); ++part) {
    if (part % 3 == 2) continue;  // some have none
    film.deposit_splats(part, {{static_cast<uint32_t>(window.y0 + 5), {1, 2, 3}},
                               {static_cast<uint32_t>(17 * part), {0.25F, 0, -0.5F}},
                               {static_cast<uint32_t>(17 * part), {1.25F, 0, 0.5F}}});
  }
  return film;
}

std::vector<Film> parts(bool splats) {
  std::vector<Film> films;
  films.push_back(part_of(splats, {4, 2, 30, 21}, {0, 2}));
  films.push_back(part_of(splats, {30, 2, 60, 21}, {0, 2}));
  films.push_back(part_of(splats, {4, 21, 60, 40}, {0, 1}));
  films.push_back(part_of(splats, {4, 2, 60, 40}, {3, 1}));
  return films;
}

Film all_of(const std::vector<Film>& films) {
  Film all(films[0].layout(), kRegion);
  for (const Film& film : films) EXPECT_TRUE(all.merge(film).ok());
  return all;
}

TEST(FilmLayers, AddUpToTheSameBitsInAnyOrder) {
  for (const bool splats : {false, true}) {
    std::vector<Film> films = parts(splats);
    const Film all = all_of(films);
    ASSERT_TRUE(all.check().ok()) << all.check().error().message;
    std::reverse(films.begin(), films.end());
    EXPECT_EQ(all_of(films).digest(), all.digest());
    films.pop_back();
    EXPECT_NE(all_of(films).digest(), all.digest());
  }
}

TEST(FilmLayers, NobodyKnowsBeforeWhatIdsTake) {
  Film film = part_of(false, {4, 2, 30, 21}, {0, 2});
  EXPECT_EQ(memory_to_decode(encode_film(film)), UINT64_MAX);
  Film plain(make_film_layout({}), {4, 2, 30, 21});
  EXPECT_LT(memory_to_decode(encode_film(plain)), uint64_t{1} << 20U);
}

TEST(FilmLayers, JoinedFilmsHoldTheSplatsOfEachPartOfBoth) {
  const std::vector<Film> films = parts(true);
  const Film all = all_of(films);
  for (size_t part = 0; part < all.part_splats().size(); ++part) {
    PartSplatLayer sum(kRegion);
    for (const Film& film : films) sum.merge(film.part_splats()[part]);
    EXPECT_EQ(sum.empty(), part % 3 == 2) << part;
    EXPECT_EQ(all.part_splats()[part].digest(), sum.digest()) << part;
  }
}

TEST(FilmLayers, ADigestSeesEveryLayer) {
  const Film film = part_of(true, kRegion, {0, 1});
  const auto differs = [&](const auto& change) {
    Film other = part_of(true, kRegion, {0, 1});
    change(other);
    return other.digest() != film.digest();
  };
  EXPECT_FALSE(differs([](Film&) {}));
  EXPECT_TRUE(differs([](Film& f) { f.deposit_splats(2, {{0, {1, 0, 0}}}); }));
  EXPECT_TRUE(differs([](Film& f) { f.mutable_ids(IdKind::object).deposit({{3, 7, 1}}); }));
  EXPECT_TRUE(differs([](Film& f) { f.mutable_ids(IdKind::material).deposit({{3, 0, 1}}); }));
  EXPECT_TRUE(differs([](Film& f) { f.mutable_ids(IdKind::object).name(7, "a name"); }));
}

TEST(FilmLayers, ComeBackFromBytes) {
  for (const bool splats : {false, true}) {
    const Film film = all_of(parts(splats));
    const std::vector<std::byte> bytes = encode_film(film);
    EXPECT_EQ(bytes[4], std::byte{3});
    const Result<Film> back = decode_film(bytes);
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->layout(), film.layout());
    EXPECT_EQ(back->digest(), film.digest());
    EXPECT_EQ(encode_film(*back), bytes);
  }
}

TEST(FilmLayers, ComeBackFromAFile) {
  const std::string path = testing::TempDir() + "film_layers_test.exr";
  for (const bool splats : {false, true}) {
    const FilmFile file{{"a", "key", 1, 64, 48, kRegion, 200, "class", "build", {}},
                        all_of(parts(splats))};
    const Status written = write_film_exr(path, file);
    ASSERT_TRUE(written.ok()) << written.error().message;
    const Result<FilmFile> back = read_film_exr(path);
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->film.layout(), file.film.layout());
    EXPECT_EQ(back->film.digest(), file.film.digest());
    EXPECT_EQ(back->film.ids(IdKind::object).names(), file.film.ids(IdKind::object).names());
  }
  std::filesystem::remove(path);
}

TEST(FilmLayers, DamageIsRefused) {
  const std::vector<std::byte> good = encode_film(part_of(true, {4, 2, 12, 8}, {0, 1}));
  int refused = 0;
  for (size_t at = 6; at + 4 < good.size(); at += 3) {
    std::vector<std::byte> bytes = good;
    bytes[at] ^= std::byte{0x41};
    const uint32_t sum = crc32c(std::span(bytes).first(bytes.size() - 4));
    std::memcpy(bytes.data() + bytes.size() - 4, &sum, 4);
    // Whatever is read without complaint is a film that agrees with itself.
    if (const Result<Film> film = decode_film(bytes)) {
      EXPECT_TRUE(film->check().ok());
    } else {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(FilmLayers, NamesOfIdsThatNoPixelHoldsAreRefused) {
  const std::string path = testing::TempDir() + "film_layers_names_test.exr";
  for (const IdKind kind : {IdKind::object, IdKind::material}) {
    Film film(make_film_layout(every_layer(false)), kRegion);
    EXPECT_TRUE(decode_film(encode_film(film)).ok()) << "nothing, and no names";
    ASSERT_TRUE(film.merge(part_of(false, kRegion, {0, 1})).ok());
    EXPECT_TRUE(decode_film(encode_film(film)).ok());
    film.mutable_ids(kind).name(8, "");
    for (const uint32_t id : {8U, 1'000'000U}) {
      const Result<Film> read = decode_film(encode_film(film));
      ASSERT_FALSE(read.ok());
      EXPECT_TRUE(read.error().message.ends_with("it names an id that no pixel holds"))
          << read.error().message;
      film.mutable_ids(kind).deposit({{0, 8, 1}});  // the first has one now
      film.mutable_ids(kind).name(id + 1'000'000U, "a name");
    }
    const FilmFile file{{"a", "key", 1, 64, 48, kRegion, 200, "class", "build", {}}, film};
    ASSERT_TRUE(write_film_exr(path, file).ok());
    EXPECT_FALSE(read_film_exr(path).ok());
  }
  std::filesystem::remove(path);
}

TEST(FilmLayers, IdsHaveTheRoomThatCountsWhateverTheirOrder) {
  LayerSet layers;
  layers.ids = {false, true};
  const FilmLayout layout = make_film_layout(layers);
  const PixelRect window{0, 0, 8, 8};
  const uint64_t most = id_room(window);
  EXPECT_EQ(film_memory(layout, window) - film_memory(make_film_layout({}), window), most);
  // Many names, and one that makes it just fit: their bytes are what counts.
  std::vector<Film> films;
  for (uint32_t part = 0; part < 4; ++part) {
    Film& film = films.emplace_back(layout, window);
    std::vector<IdCount> counts;
    for (uint32_t i = 0; i < 5000; ++i) {
      const uint32_t id = 1 + i * 3 + part;  // some are in two
      counts.push_back({id % 64, id, 1});
      film.mutable_ids(IdKind::material).name(id, std::string(part == 3 ? 140 : 150, 'm'));
    }
    film.mutable_ids(IdKind::material).deposit(std::move(counts));
  }
  Film all(layout, window);
  Film other(layout, window);
  for (size_t i = 0; i < films.size(); ++i) {
    all.mutable_ids(IdKind::material).merge(films[i].ids(IdKind::material));
    other.mutable_ids(IdKind::material).merge(films[3 - i].ids(IdKind::material));
  }
  EXPECT_EQ(all.ids(IdKind::material).digest(), other.ids(IdKind::material).digest());
  EXPECT_EQ(all.memory(), other.memory());
  ASSERT_LT(all.ids(IdKind::material).memory(), most);
  EXPECT_TRUE(all.check_id_room().ok());
  all.mutable_ids(IdKind::material)
      .name(1U << 30U, std::string(most - all.ids(IdKind::material).memory(), 'm'));
  const Status fits = all.check_id_room();
  ASSERT_FALSE(fits.ok());
  for (const char* said : {"crypto_material", "material_id", "fewer samples", "aperture"})
    EXPECT_NE(fits.error().message.find(said), std::string::npos) << fits.error().message;
  all.erase(window);
  EXPECT_EQ(all.ids(IdKind::material).memory(), 0U);
  EXPECT_TRUE(all.check_id_room().ok());
}

TEST(FilmLayers, ErasedTilesLeaveNoIds) {
  Film film = part_of(false, kRegion, {0, 1});
  Film west = part_of(false, {4, 2, 30, 40}, {0, 1});
  Film east(film.layout(), kRegion);
  film.erase({4, 2, 30, 40});
  EXPECT_TRUE(film.ids(IdKind::object).at(10, 10).empty());
  ASSERT_TRUE(film.merge(west).ok());
  EXPECT_EQ(film.digest(), part_of(false, kRegion, {0, 1}).digest());
  film.erase(kRegion);
  EXPECT_EQ(film.digest(), east.digest());
}

TEST(FilmLayers, PartsOfSplatsAreDividedByAllSamples) {
  LayerSet layers{.splats = true};
  layers.light_groups = {"key"};
  Film film(make_film_layout(layers), {10, 20, 12, 21}, {10, 20, 12, 21});
  film.deposit(film.window(), 0, 2, std::vector<float>{4, 4, 4, 2, 2, 2, 2, 8, 8, 8, 2, 4, 4, 4});
  film.deposit_splats({{1, {40, 0, 0}}});
  film.deposit_splats(0, {{1, {20, 0, 0}}});
  const Image image = film.normalised();
  EXPECT_EQ(image.at(0, 0, image.find_channel("light_group_key.R")), 1.0F);
  EXPECT_EQ(image.at(1, 0, image.find_channel("light_group_key.R")), 7.0F);
  EXPECT_EQ(image.at(1, 0, image.find_channel("R")), 14.0F);
}

TEST(FilmLayers, TextsComeBack) {
  for (const LayerSet& layers : {LayerSet{}, every_layer(false), every_layer(true)}) {
    const Result<LayerSet> back = parse_layers(layers_text(layers));
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(*back, layers);
  }
  EXPECT_EQ(layers_text(LayerSet{.depth = true, .splats = true}), "depth, splats");
  for (const char* wrong : {"deep", "depth,albedo", "albedo, depth", "depth, depth", "depth, ",
                            "light_group:b, light_group:a", "light_group:a, light_group:a"}) {
    EXPECT_FALSE(parse_layers(wrong).ok()) << wrong;
  }
}

}  // namespace
}  // namespace hyades::core
