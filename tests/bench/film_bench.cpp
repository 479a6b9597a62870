// What the coordinator does with a film, per core: merging it, decoding it, hashing it. Bytes are
// those of the film in memory (16 per pixel and channel), each read once; merging also reads and
// writes as many of the frame's film.
#include <benchmark/benchmark.h>

#include <cstring>

#include "core/film/film_codec.h"
#include "tests/coordinator/services/fake_films.h"

namespace hyades::core {
namespace {

constexpr int kTile = 32;
const FilmLayout& layout() {
  static const FilmLayout all = make_film_layout({});
  return all;
}

int64_t bytes_of(const Film& film) {
  return film.window().area() * static_cast<int64_t>(layout().channels.size() * sizeof(Fixed128));
}

Film tile_film(int x, int y) {
  return coordinator::fake_film(
      {1, {x * kTile, y * kTile, (x + 1) * kTile, (y + 1) * kTile}, {0, 1}}, kBatchSamples,
      layout());
}

/// Every tile of a frame of `side` x `side` tiles into a new frame's film.
void merge(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  std::vector<Film> tiles;
  int64_t bytes = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      tiles.push_back(tile_film(x, y));
      bytes += bytes_of(tiles.back());
    }
  }
  const PixelRect window{0, 0, side * kTile, side * kTile};
  for (auto _ : state) {
    state.PauseTiming();
    Film whole(layout(), window);  // its memory is touched here
    state.ResumeTiming();
    for (const Film& tile : tiles) {
      if (!whole.merge(tile)) state.SkipWithError("a film does not merge");
    }
  }
  state.SetBytesProcessed(bytes * state.iterations());
}
BENCHMARK(merge)->ArgName("side")->Arg(1)->Arg(4)->Arg(32)->UseRealTime();

/// The same traffic of memory without arithmetic beyond one addition of 64 bits: the ceiling.
void add_memory(benchmark::State& state) {
  const auto side = static_cast<size_t>(state.range(0));
  const size_t numbers = side * side * static_cast<size_t>(bytes_of(tile_film(0, 0))) / 8;
  std::vector<uint64_t> into(numbers, 1);
  const std::vector<uint64_t> from(numbers, 2);
  for (auto _ : state) {
    for (size_t i = 0; i < numbers; ++i) into[i] += from[i];
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<int64_t>(8 * numbers) * state.iterations());
}
BENCHMARK(add_memory)->ArgName("side")->Arg(1)->Arg(4)->Arg(32)->UseRealTime();

void encode(benchmark::State& state) {
  const Film film = tile_film(3, 5);
  for (auto _ : state) benchmark::DoNotOptimize(encode_film(film));
  state.SetBytesProcessed(bytes_of(film) * state.iterations());
}
BENCHMARK(encode);

void decode(benchmark::State& state) {
  const Film film = tile_film(3, 5);
  const std::vector<std::byte> bytes = encode_film(film);
  for (auto _ : state) benchmark::DoNotOptimize(decode_film(bytes));
  state.SetBytesProcessed(bytes_of(film) * state.iterations());
}
BENCHMARK(decode);

void digest(benchmark::State& state) {
  const Film film = tile_film(3, 5);
  for (auto _ : state) benchmark::DoNotOptimize(film.digest());
  state.SetBytesProcessed(bytes_of(film) * state.iterations());
}
BENCHMARK(digest);

}  // namespace
}  // namespace hyades::core

BENCHMARK_MAIN();
