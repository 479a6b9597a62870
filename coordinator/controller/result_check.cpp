#include "coordinator/controller/result_check.h"

#include <span>
#include <utility>

#include "core/film/film_codec.h"
#include "core/film/id_codec.h"
#include "core/film/splat_codec.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using Rejected = v1::Rejected;

/// Bytes of a decoded film besides its pixels.
constexpr uint64_t kFilmOverhead = uint64_t{1} << 20U;

/// The most that the film of a unit may take when it is decoded.
uint64_t most_memory(const ExpectedFilm& expected, const core::Unit& unit) {
  const core::FilmLayout& layout = expected.layout;
  uint64_t memory = core::film_memory(layout, unit.tile) + kFilmOverhead;
  if (layout.layers.splats) {
    memory += core::splat_memory(static_cast<uint64_t>(expected.region.area())) *
              (1 + layout.part_count());
  }
  const uint64_t samples =
      static_cast<uint64_t>(unit.tile.area()) * unit.batches.count * core::kBatchSamples;
  for (const bool ids : layout.layers.ids) memory += ids ? core::id_memory(samples) : 0;
  return memory;
}

bool is_of(const core::Film& film, const ExpectedFilm& expected, const core::Unit& unit) {
  const core::PixelRect splats =
      expected.layout.layers.splats ? expected.region : core::PixelRect{};
  return film.layout() == expected.layout && film.window() == unit.tile &&
         film.splats().region() == splats &&
         film.coverage().volume() == static_cast<uint64_t>(unit.tile.area()) * unit.batches.count &&
         film.coverage().contains({unit.tile, unit.batches});
}

}  // namespace

std::optional<ResultRefusal> check_claim(const v1::UnitResult& result,
                                         const std::optional<ExpectedFilm>& expected,
                                         const LeaseProofs& proofs) {
  const auto unit = farm::from_wire(result.unit());
  if (!unit) return ResultRefusal{Rejected::REASON_MALFORMED, unit.error().message};
  const auto digest = farm::digest_from_wire(result.digest());
  if (!digest) return ResultRefusal{Rejected::REASON_MALFORMED, digest.error().message};
  if (!expected) return ResultRefusal{Rejected::REASON_UNKNOWN, "there is no such job"};
  if (!proofs.holds(result.unit().proof(), expected->worker, JobId{result.job()}, *unit)) {
    return ResultRefusal{Rejected::REASON_UNKNOWN, "the unit was not leased to this worker"};
  }
  return std::nullopt;
}

std::variant<Delivery, ResultRefusal> check_result(const v1::UnitResult& result,
                                                   const ExpectedFilm& expected) {
  const core::Unit unit = *farm::from_wire(result.unit());
  const Digest digest = *farm::digest_from_wire(result.digest());
  const std::span<const std::byte> bytes = std::as_bytes(std::span(result.film()));
  auto film = core::decode_film(bytes, {most_memory(expected, unit), 1});
  if (!film) return ResultRefusal{Rejected::REASON_DAMAGED, film.error().message};
  if (!is_of(*film, expected, unit)) {
    return ResultRefusal{Rejected::REASON_MALFORMED,
                         "the film is not of the unit that it is said to be of"};
  }
  if (film->digest() != core::to_hex(digest)) {
    return ResultRefusal{Rejected::REASON_DAMAGED, "the film is not what its digest says"};
  }
  Delivery delivery;
  delivery.unit.worker_class = expected.worker_class;
  delivery.unit.unit = unit;
  delivery.unit.digest = digest;
  delivery.record = encode_delivered(delivery.unit, expected.key, bytes);
  delivery.film = std::move(*film);
  return delivery;
}

}  // namespace hyades::coordinator
