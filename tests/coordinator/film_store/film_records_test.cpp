// Films that turned out wrong stay out, also after a restart.
#include <gtest/gtest.h>

#include "coordinator/film_store/film_records.h"
#include "core/film/film_codec.h"
#include "tests/coordinator/film_store/fake_film.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kSamples = 40;
const core::PixelRect kRegion{0, 0, 32, 16};
const core::Unit kLeft{1, {0, 0, 16, 16}, {0, 2}};
const core::Unit kRight{1, {16, 0, 32, 16}, {0, 3}};

std::vector<std::byte> delivered(const core::Unit& unit, uint32_t samples) {
  const core::Film film = fake_film(unit, samples);
  return encode_delivered({unit, {}, "class"}, {}, core::encode_film(film));
}

/// What a log with these records holds when it is opened again.
LogContents replayed(const std::vector<std::vector<std::byte>>& records) {
  const test::TempFolder folder;
  const std::string place = folder.file("films");
  {
    auto log = FilmLog::open(place, "key");
    EXPECT_TRUE((*log)->replay([](auto) { return core::Status(); }).ok());
    EXPECT_TRUE((*log)->append(encode_cut({kRegion, 16, kSamples})).ok());
    for (const auto& record : records) EXPECT_TRUE((*log)->append(record).ok());
    EXPECT_TRUE((*log)->sync().ok());
  }
  auto log = FilmLog::open(place, "key");
  auto contents = read_log(**log, {{1}, kRegion, kSamples, {}});
  EXPECT_TRUE(contents.ok()) << (contents ? "" : contents.error().message);
  return *contents;
}

TEST(VoidedTile, TakesOutWhatCameBeforeAndKeepsWhatCameAfter) {
  const core::Unit again{1, kLeft.tile, {1, 2}};
  // The wrong film is of other samples, so that its sums differ.
  const LogContents contents =
      replayed({delivered(kLeft, kSamples - 10), delivered(kRight, kSamples),
                encode(TileVoidedRecord{{}, 1, kLeft.tile}), delivered(again, kSamples)});
  core::Film right(fake_film(kRight, kSamples).layout(), kRegion);
  ASSERT_TRUE(right.merge(fake_film(kRight, kSamples)).ok());
  ASSERT_TRUE(right.merge(fake_film(again, kSamples)).ok());
  EXPECT_EQ(contents.films.at(1)->digest(), right.digest());
  ASSERT_EQ(contents.units.at(1).size(), 2U);
  EXPECT_EQ(contents.units.at(1)[0].unit, kRight);
  EXPECT_EQ(contents.units.at(1)[1].unit, again);
}

TEST(Dispute, IsOpenUntilTheLogSaysOtherwise) {
  EXPECT_FALSE(replayed({delivered(kLeft, kSamples)}).disputed);
  EXPECT_TRUE(replayed({encode(DisputeRecord{{}, true}), delivered(kLeft, kSamples)}).disputed);
  EXPECT_FALSE(
      replayed({encode(DisputeRecord{{}, true}), encode(DisputeRecord{{}, false})}).disputed);
}

TEST(VoidedTile, LeavesNothingOfAFrameThatHadNoOther) {
  const LogContents contents =
      replayed({delivered(kLeft, kSamples), encode(TileVoidedRecord{{}, 1, kLeft.tile})});
  EXPECT_TRUE(contents.films.empty());
  EXPECT_TRUE(contents.units.empty());
  EXPECT_TRUE(contents.problems.empty());
}

/// The records of which a snapshot of the film consists.
std::vector<std::vector<std::byte>> written(const core::Film& film,
                                            const std::string& worker_class) {
  std::vector<std::vector<std::byte>> records;
  EXPECT_TRUE(write_film(1, {}, film, {kRegion, 16, kSamples}, worker_class,
                         [&](std::span<const std::byte> record) -> core::Status {
                           records.emplace_back(record.begin(), record.end());
                           return {};
                         }));
  return records;
}

/// A snapshot of a film with splats is one record: none of it can be lost without the rest.
TEST(WrittenFilm, IsOneRecordWhereThereAreSplats) {
  const core::PixelRect region{0, 0, 40, 20};
  for (const bool splats : {false, true}) {
    const core::PixelRect of = splats ? region : core::PixelRect{};
    core::Film whole(fake_film(kLeft, kSamples, of).layout(), kRegion, of);
    ASSERT_TRUE(whole.merge(fake_film(kLeft, kSamples, of)));
    ASSERT_TRUE(whole.merge(fake_film(kRight, kSamples, of)));
    for (const std::string worker_class : {"", "class"}) {
      const std::vector<std::vector<std::byte>> records = written(whole, worker_class);
      EXPECT_EQ(records.size(), splats ? 1U : 2U);
      const LogContents contents = replayed(records);
      EXPECT_EQ(contents.films.at(1)->digest(), whole.digest());
      if (worker_class.empty()) continue;
      ASSERT_EQ(contents.units.at(1).size(), 2U);
      EXPECT_EQ(contents.units.at(1)[0].unit, kLeft);
      EXPECT_EQ(contents.units.at(1)[1].unit, kRight);
    }
  }
}

TEST(WrittenFilm, KeepsTheIdsOfEachTileAndTheirNames) {
  core::LayerSet layers;
  layers.ids = {true, true};
  core::Film whole(core::make_film_layout(layers), kRegion);
  const std::vector<float> black(16 * 16 * static_cast<size_t>(whole.layout().deposited));
  for (const core::Unit& unit : {kLeft, kRight}) {
    for (uint32_t b = 0; b < unit.batches.count; ++b)
      whole.deposit(unit.tile, b, core::samples_in_batch(b, kSamples), black);
  }
  for (const core::IdKind kind : {core::IdKind::object, core::IdKind::material}) {
    core::IdLayer& ids = whole.mutable_ids(kind);
    ids.deposit({{3, 7, 2}, {3, 9, 1}, {31, 9, 5}, {32 * 15 + 16, 11, 1}, {40, 0, 4}});
    for (const uint32_t id : {7U, 9U, 11U}) ids.name(id, "object " + std::to_string(id));
  }
  ASSERT_TRUE(whole.check());
  for (const std::string worker_class : {"", "class"}) {
    const std::vector<std::vector<std::byte>> records = written(whole, worker_class);
    EXPECT_EQ(records.size(), 2U);
    EXPECT_EQ(replayed(records).films.at(1)->digest(), whole.digest());
  }
}

TEST(BegunAgain, LeavesNothingOfTheSplatsThatCameBefore) {
  const core::PixelRect region{0, 0, 40, 20};
  const auto splatted = [&](const core::Unit& unit, uint32_t samples) {
    return encode_delivered({unit, {}, "class"}, {},
                            core::encode_film(fake_film(unit, samples, region)));
  };
  const LogContents contents =
      replayed({splatted(kLeft, kSamples - 10), splatted(kRight, kSamples),
                encode(FrameRestartedRecord{{}, 1}), splatted(kLeft, kSamples)});
  core::Film right(fake_film(kLeft, kSamples, region).layout(), kRegion, region);
  ASSERT_TRUE(right.merge(fake_film(kLeft, kSamples, region)));
  EXPECT_EQ(contents.films.at(1)->digest(), right.digest());
  EXPECT_EQ(contents.units.at(1).size(), 1U);
}

}  // namespace
}  // namespace hyades::coordinator
