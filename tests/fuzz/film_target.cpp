// A film as it travels and lies in the log. What is read must be a film that can be used: it is
// written again, and must give the same bytes when that is done twice.

#include <cstdlib>

#include "core/film/film_codec.h"
#include "tests/core/film/film_testing.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"

namespace hyades::fuzz {
namespace {

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::vector<std::string> seeds() {
  const core::FilmLayout all = core::make_film_layout(core::kAllLayers);
  const core::PixelRect tile{0, 0, 5, 4};
  core::LayerSet with_splats = core::kAllLayers;
  with_splats.splats = true;
  const core::FilmLayout splats = core::make_film_layout(with_splats);
  return {text_of(core::encode_film(core::render(all, tile, {0, 2}))),
          text_of(core::encode_film(core::render(all, tile, {3, 1}, 50))),
          text_of(core::encode_film(core::render_with_splats(splats, tile, {0, 1}, {0, 0, 9, 9})))};
}

bool try_input(std::string_view input) {
  const core::Bytes bytes = exact_bytes(input);
  const auto film = core::decode_film(bytes.span(), {uint64_t{64} << 20U});
  if (!film) return false;
  if (!film->check()) std::abort();
  const auto again = core::encode_film(*film);
  const auto back = core::decode_film(again, {uint64_t{64} << 20U});
  if (!back || core::encode_film(*back) != again) std::abort();
  return true;
}

}  // namespace hyades::fuzz
