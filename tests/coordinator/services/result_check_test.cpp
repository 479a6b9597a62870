#include "coordinator/controller/result_check.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "core/film/film_codec.h"
#include "farm/wire.h"
#include "tests/coordinator/services/fake_films.h"

namespace hyades::coordinator {
namespace {

TEST(ResultCheck, WhatNobodyWasLeasedIsNotDecoded) {
  const LeaseProofs proofs("secret");
  const core::Unit unit{.frame = 3, .tile = {0, 0, 16, 16}, .batches = {0, 2}};
  v1::UnitResult result;
  result.set_job(7);
  *result.mutable_unit() = farm::to_wire(unit);
  result.set_digest(std::string(32, 'd'));
  result.set_film("no film at all");
  ExpectedFilm expected;
  expected.worker = "a-worker-of-this-farm";
  const auto reason = [&](const std::string& proof) {
    result.mutable_unit()->set_proof(proof);
    const auto refusal = check_claim(result, expected, proofs);
    return refusal ? refusal->reason : v1::Rejected::REASON_UNSPECIFIED;
  };
  EXPECT_EQ(reason(""), v1::Rejected::REASON_UNKNOWN);
  EXPECT_EQ(reason(proofs.make("another-worker-of-it", JobId{7}, unit)),
            v1::Rejected::REASON_UNKNOWN);
  EXPECT_EQ(reason(proofs.make(expected.worker, JobId{8}, unit)), v1::Rejected::REASON_UNKNOWN);
  EXPECT_EQ(reason(proofs.make(expected.worker, JobId{7}, unit)), v1::Rejected::REASON_UNSPECIFIED);
  const auto looked_at = check_result(result, expected);
  EXPECT_EQ(std::get<ResultRefusal>(looked_at).reason, v1::Rejected::REASON_DAMAGED);
}

/// What is said of a worker's film of `unit`.
std::string refusal_of(const core::Film& film, const core::Unit& unit) {
  ExpectedFilm expected;
  expected.layout = film.layout();
  expected.region = unit.tile;
  v1::UnitResult result;
  result.set_job(7);
  *result.mutable_unit() = farm::to_wire(unit);
  const std::vector<std::byte> bytes = core::encode_film(film);
  result.set_film(bytes.data(), bytes.size());
  result.set_digest(farm::to_wire(*farm::digest_from_hex(film.digest())));
  const auto checked = check_result(result, expected);
  const auto* refusal = std::get_if<ResultRefusal>(&checked);
  return refusal == nullptr ? "" : refusal->text;
}

TEST(ResultCheck, NamesThatNoPixelHasStayNowhere) {
  core::LayerSet layers;
  layers.ids = {true, false};
  const core::Unit unit{.frame = 3, .tile = {0, 0, 16, 16}, .batches = {0, 2}};
  core::Film film = fake_film(unit, 32, core::make_film_layout(layers));
  core::IdLayer& ids = film.mutable_ids(core::IdKind::object);
  ids.deposit({{5, 77, 3}});
  ids.name(77, "ball");
  EXPECT_EQ(refusal_of(film, unit), "");
  for (uint32_t id = 1000; id < 121'000; ++id) ids.name(id, "");
  EXPECT_TRUE(refusal_of(film, unit).ends_with("it names an id that no pixel holds"));
}

TEST(ResultCheck, SumsOfSquaresAreNotNegative) {
  const core::Unit unit{.frame = 3, .tile = {0, 0, 16, 16}, .batches = {0, 2}};
  core::Film film = fake_film(unit, 32, core::make_film_layout({}));
  EXPECT_EQ(refusal_of(film, unit), "");
  film.mutable_plane(film.layout().moment2)[9] = {0, -1};
  EXPECT_TRUE(refusal_of(film, unit).ends_with("a sum of squares is negative"));
}

}  // namespace
}  // namespace hyades::coordinator
