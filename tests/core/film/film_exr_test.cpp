#include "core/film/film_exr.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/film/film_header.h"
#include "core/image/read_image.h"
#include "tests/core/film/film_testing.h"

namespace hyades::core {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test.
class FilmExr : public ::testing::Test {
 protected:
  FilmExr() {
    folder_ = fs::path(::testing::TempDir()) /
              ("hyades_film_exr_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FilmExr() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

/// Bytes that end where their memory ends, so that sanitizers see who reads too far.
Result<FilmFile> read_from_memory(const std::string& bytes) {
  const auto copy = std::make_shared<std::vector<char>>(bytes.begin(), bytes.end());
  return read_film_exr(Bytes(copy, std::as_bytes(std::span(*copy))), "some.exr");
}

FilmInfo info() {
  return {"a job\nwith \\ odd \"names\"",
          "0123abcd",
          -7,
          64,
          48,
          {4, 2, 60, 40},
          200,
          "class7",
          "hyades 0.1",
          {0.02F, -1.5F, 48}};
}

FilmFile patchwork_file(const LayerSet& layers = kAllLayers) {
  const FilmLayout layout = make_film_layout(layers);
  FilmFile file{info(), Film(layout, {10, 5, 42, 30})};
  EXPECT_TRUE(file.film.merge(render(layout, {10, 5, 26, 20}, {0, 5}, 200)).ok());
  EXPECT_TRUE(file.film.merge(render(layout, {26, 5, 40, 30}, {12, 1}, 200)).ok());
  return file;
}

const LayerSet kSplats{.depth = true, .splats = true};

/// Splats lie in all of the crop, so that the file's window is that.
FilmFile splatted(const PixelRect& window, BatchRange batches) {
  return {info(), render_with_splats(make_film_layout(kSplats), window, batches, info().crop, 200)};
}

TEST_F(FilmExr, SplatsComeBackFromAllOfTheRegion) {
  const FilmFile file = splatted(info().crop, {0, 1});
  ASSERT_TRUE(write_film_exr(path("a.exr"), file).ok());
  const Result<FilmFile> back = read_film_exr(path("a.exr"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->film.digest(), file.film.digest());

  // Half of the picture holds its part of the splats everywhere.
  const FilmFile north = splatted({4, 2, 60, 20}, {0, 1});
  const FilmFile south = splatted({4, 20, 60, 40}, {0, 1});
  ASSERT_TRUE(write_film_exr(path("north.exr"), north).ok());
  ASSERT_TRUE(write_film_exr(path("south.exr"), south).ok());
  Result<FilmFile> half = read_film_exr(path("north.exr"));
  ASSERT_TRUE(half.ok()) << half.error().message;
  EXPECT_EQ(half->film.window(), info().crop);
  EXPECT_EQ(half->film.coverage().canonical(), north.film.coverage().canonical());
  EXPECT_EQ(half->film.splats().digest(), north.film.splats().digest());
  const Result<FilmFile> other = read_film_exr(path("south.exr"));
  ASSERT_TRUE(other.ok()) << other.error().message;
  ASSERT_TRUE(merge_film_files(*half, *other));
  EXPECT_EQ(half->film.digest(), file.film.digest());
  FilmFile in_memory = north;
  ASSERT_TRUE(merge_film_files(in_memory, south));
  EXPECT_EQ(in_memory.film.digest(), file.film.digest());
}

TEST_F(FilmExr, GivesBackTheSameBits) {
  for (const LayerSet& layers : {LayerSet{}, LayerSet{true, false, false}, kAllLayers}) {
    const FilmFile file = patchwork_file(layers);
    ASSERT_TRUE(write_film_exr(path("a.exr"), file, {{"comments", "hello"}}).ok());
    const Result<FilmFile> back = read_film_exr(path("a.exr"));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->film.digest(), file.film.digest());
    EXPECT_EQ(back->film.coverage().canonical(), file.film.coverage().canonical());
    EXPECT_EQ(back->info.job_name, file.info.job_name);
    EXPECT_EQ(back->info.render_key, file.info.render_key);
    EXPECT_EQ(back->info.frame, file.info.frame);
    EXPECT_EQ(back->info.width, file.info.width);
    EXPECT_EQ(back->info.height, file.info.height);
    EXPECT_EQ(back->info.crop, file.info.crop);
    EXPECT_EQ(back->info.samples, file.info.samples);
    EXPECT_EQ(back->info.worker_class, file.info.worker_class);
    EXPECT_EQ(back->info.build, file.info.build);
    EXPECT_EQ(back->info.aim, file.info.aim);
  }
}

TEST_F(FilmExr, WhatItTakesIsKnownBeforeItIsRead) {
  const FilmFile file = splatted({4, 2, 60, 20}, {0, 1});
  ASSERT_TRUE(write_film_exr(path("a.exr"), file).ok());
  const std::string bytes = read_bytes(path("a.exr"));
  const auto memory = film_exr_memory(Bytes(nullptr, std::as_bytes(std::span(bytes))), "a.exr");
  ASSERT_TRUE(memory.ok()) << memory.error().message;
  EXPECT_EQ(*memory, film_memory(file.film.layout(), info().crop));
  EXPECT_FALSE(film_exr_memory(Bytes(nullptr, std::as_bytes(std::span("none"))), "a.exr").ok());
}

TEST_F(FilmExr, ExtremeSumsSurvive) {
  constexpr int64_t kMost = 1'099'500'000'000;  // of one batch
  FilmFile file = patchwork_file({});
  file.film.mutable_plane(0)[0] = {0, -kMost};
  file.film.mutable_plane(0)[1] = {~uint64_t{0}, kMost - 1};
  file.film.mutable_plane(1)[2] = {1, 0};
  file.film.mutable_plane(2)[3] = {~uint64_t{0}, -1};
  ASSERT_TRUE(write_film_exr(path("a.exr"), file).ok());
  EXPECT_EQ(read_film_exr(path("a.exr"))->film.digest(), file.film.digest());
}

TEST_F(FilmExr, AnyViewerSeesThePicture) {
  const FilmFile file = patchwork_file();
  ASSERT_TRUE(write_film_exr(path("a.exr"), file).ok());
  const Result<Image> seen = read_image_file(path("a.exr"));
  ASSERT_TRUE(seen.ok()) << seen.error().message;
  const Image expected = file.film.normalised();
  ASSERT_EQ(seen->width, expected.width);
  ASSERT_EQ(seen->height, expected.height);
  ASSERT_EQ(seen->channel_count(), expected.channel_count());
  for (int c = 0; c < expected.channel_count(); ++c) {
    const int found = seen->find_channel(expected.channels[static_cast<size_t>(c)]);
    ASSERT_GE(found, 0);
    for (int y = 0; y < expected.height; ++y) {
      for (int x = 0; x < expected.width; ++x) {
        ASSERT_EQ(seen->at(x, y, found), expected.at(x, y, c));
      }
    }
  }
}

TEST_F(FilmExr, TheSameFilmGivesTheSameFile) {
  ASSERT_TRUE(write_film_exr(path("a.exr"), patchwork_file()).ok());
  const FilmLayout layout = make_film_layout(kAllLayers);
  FilmFile other{info(), Film(layout, {10, 5, 42, 30})};
  ASSERT_TRUE(other.film.merge(render(layout, {26, 9, 40, 30}, {12, 1}, 200)).ok());
  ASSERT_TRUE(other.film.merge(render(layout, {10, 5, 26, 20}, {3, 2}, 200)).ok());
  ASSERT_TRUE(other.film.merge(render(layout, {26, 5, 40, 9}, {12, 1}, 200)).ok());
  ASSERT_TRUE(other.film.merge(render(layout, {10, 5, 26, 20}, {0, 3}, 200)).ok());
  ASSERT_TRUE(write_film_exr(path("b.exr"), other).ok());
  EXPECT_TRUE(read_bytes(path("a.exr")) == read_bytes(path("b.exr")));
}

TEST_F(FilmExr, RefusesToWriteWhatDoesNotFit) {
  FilmFile file = patchwork_file();
  file.info.crop = {12, 5, 60, 40};
  EXPECT_FALSE(write_film_exr(path("a.exr"), file).ok());
  file = patchwork_file();
  file.info.width = 30;
  EXPECT_FALSE(write_film_exr(path("a.exr"), file).ok());
  EXPECT_FALSE(write_film_exr(path("a.exr"), {info(), Film()}).ok());
  for (const char* name : {"channels", "name", "hyades.film", "", "dataWindow"}) {
    EXPECT_FALSE(write_film_exr(path("a.exr"), patchwork_file(), {{name, "x"}}).ok()) << name;
  }
  EXPECT_FALSE(fs::exists(path("a.exr")));
  const Status nowhere = write_film_exr(path("none/a.exr"), patchwork_file());
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().message.find("none/a.exr"), std::string::npos);
}

TEST_F(FilmExr, TruncatedFilesAreRefused) {
  ASSERT_TRUE(write_film_exr(path("a.exr"), patchwork_file()).ok());
  const std::string whole = read_bytes(path("a.exr"));
  for (size_t size = 0; size < whole.size();
       size += size < 1500 || size + 100 > whole.size() ? 1 : 41) {
    const Result<FilmFile> cut = read_from_memory(whole.substr(0, size));
    ASSERT_FALSE(cut.ok()) << size << " of " << whole.size();
    ASSERT_NE(cut.error().message.find("some.exr"), std::string::npos);
  }
}

/// A damaged byte is noticed, or it lies where it cannot change the film (the picture part).
TEST_F(FilmExr, DamagedFilesAreRefusedOrGiveTheSameFilm) {
  const FilmFile plain = patchwork_file({true, false, false});
  const FilmFile splats = splatted(info().crop, {0, 1});
  ASSERT_TRUE(write_film_exr(path("a.exr"), plain).ok());
  ASSERT_TRUE(write_film_exr(path("b.exr"), splats).ok());
  const std::string digests[] = {plain.film.digest(), splats.film.digest()};
  const std::string files[] = {read_bytes(path("a.exr")), read_bytes(path("b.exr"))};
  std::mt19937 random(4);
  int refused = 0;
  for (int i = 0; i < 2500; ++i) {
    const std::string& whole = files[i % 5 == 0 ? 1 : 0];
    const std::string& digest = digests[i % 5 == 0 ? 1 : 0];
    std::string damaged = whole;
    const size_t range = i % 2 == 0 ? std::min<size_t>(2000, whole.size()) : whole.size();
    for (int k = 1 + static_cast<int>(random() % 2); k > 0; --k) {
      damaged[random() % range] ^= static_cast<char>(1 << (random() % 8));
    }
    const Result<FilmFile> back = read_from_memory(damaged);
    if (!back.ok()) {
      ++refused;
      continue;
    }
    ASSERT_EQ(back->film.digest(), digest);
    ASSERT_EQ(back->info.render_key, plain.info.render_key);
  }
  EXPECT_GT(refused, 1000);
}

TEST_F(FilmExr, ForeignFilesAreRefusedWithTheReason) {
  write_bytes(path("text.exr"), "no picture at all");
  EXPECT_NE(read_film_exr(path("text.exr")).error().message.find("no OpenEXR file"),
            std::string::npos);
  ASSERT_TRUE(write_exr(path("plain.exr"), make_image(4, 4, {"R", "G", "B"})).ok());
  EXPECT_NE(read_film_exr(path("plain.exr")).error().message.find("no film of Hyades"),
            std::string::npos);
  EXPECT_NE(read_film_exr(path("missing.exr")).error().message.find(path("missing.exr")),
            std::string::npos);
}

TEST_F(FilmExr, HeadersThatDoNotAgreeAreRefused) {
  const FilmFile file = patchwork_file();
  const std::string good = write_film_header(file);
  ASSERT_TRUE(parse_film_header(good).ok());
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const Result<FilmHeader> parsed = parse_film_header(text);
    return parsed.ok() ? std::string() : parsed.error().message;
  };
  EXPECT_NE(changed("film 1", "film 4").find("newer version"), std::string::npos);
  EXPECT_NE(changed("film 1", "film 2").find("damaged"), std::string::npos)
      << "of films with splats";
  EXPECT_NE(changed("film 1", "film 0"), "");
  EXPECT_NE(changed("holds 10 5", "holds 9 5").find("outside its window"), std::string::npos);
  EXPECT_NE(changed("window 10 5", "window 3 5").find("not inside the crop"), std::string::npos);
  EXPECT_NE(changed("size 64 48", "size 40 48").find("not inside"), std::string::npos);
  EXPECT_NE(changed("size 64 48", "size 64 48 1").find("damaged"), std::string::npos);
  EXPECT_NE(changed("size 64 48", "size 99999999 48").find("absurd"), std::string::npos);
  EXPECT_NE(changed("frame -7\n", ""), "");
  EXPECT_NE(changed("samples 200", "samples 99999999999"), "");
  for (size_t size = 0; size < good.size(); ++size) {
    // Cut after a whole line the coverage is smaller, which check() and the digest notice.
    if (size > 0 && good[size - 1] == '\n' && good.find("holds") < size) continue;
    if (size > 0 && good[size - 1] == '\n' && good.find("window") < size) continue;
    EXPECT_FALSE(parse_film_header(good.substr(0, size)).ok()) << size;
  }
}

TEST_F(FilmExr, MergedFilesEqualTheWhole) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const auto part = [&](const PixelRect& tile, BatchRange batches) {
    return FilmFile{info(), render(layout, tile, batches, 200)};
  };
  FilmFile whole = part({4, 2, 60, 40}, {0, 13});
  // Parts side by side, whose windows grow into each other.
  FilmFile joined = part({30, 20, 60, 40}, {0, 13});
  ASSERT_TRUE(merge_film_files(joined, part({4, 2, 30, 40}, {5, 8})).ok());
  ASSERT_TRUE(merge_film_files(joined, part({30, 2, 60, 20}, {0, 13})).ok());
  ASSERT_TRUE(merge_film_files(joined, part({4, 2, 30, 40}, {0, 5})).ok());
  EXPECT_EQ(joined.film.digest(), whole.film.digest());
}

TEST_F(FilmExr, RefusalsNameTheReason) {
  const FilmLayout layout = make_film_layout(kAllLayers);
  const FilmFile file = patchwork_file();
  const auto refusal = [&](auto change) {
    FilmFile into = file;
    FilmFile from{info(), render(layout, {50, 30, 60, 40}, {0, 2}, 200)};
    change(from);
    const Status merged = merge_film_files(into, from);
    EXPECT_FALSE(merged.ok());
    EXPECT_EQ(into.film.digest(), file.film.digest()) << "nothing may change";
    return merged.ok() ? std::string() : merged.error().message;
  };
  EXPECT_EQ(refusal([](FilmFile& f) { f.info.frame = 8; }), "the frame differs: 8 here, -7 there");
  EXPECT_EQ(refusal([](FilmFile& f) { f.info.render_key = "ffff"; }),
            "the render key (what decides the pixels) differs: ffff here, 0123abcd there");
  EXPECT_EQ(refusal([](FilmFile& f) { f.info.width = 65; }),
            "the frame's size differs: 65 x 48 here, 64 x 48 there");
  EXPECT_NE(refusal([](FilmFile& f) { f.info.crop.y1 = 41; }).find("crop"), std::string::npos);
  EXPECT_NE(refusal([](FilmFile& f) { f.info.samples = 1; }).find("samples"), std::string::npos);
  EXPECT_NE(refusal([](FilmFile& f) { f.info.worker_class = ""; }).find("none here"),
            std::string::npos);
  EXPECT_NE(refusal([&](FilmFile& f) {
              f.film = render(layout, {8, 8, 12, 12}, {4, 3}, 200);
            }).find("both films hold batches 4 to 4 of pixels x 10 to 11, y 8 to 11"),
            std::string::npos);
  EXPECT_NE(refusal([](FilmFile& f) {
              f.film = render(make_film_layout({}), {50, 30, 60, 40}, {0, 2}, 200);
            }).find("different layers"),
            std::string::npos);
}

}  // namespace
}  // namespace hyades::core
