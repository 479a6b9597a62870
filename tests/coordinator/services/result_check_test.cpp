#include "coordinator/controller/result_check.h"

#include <gtest/gtest.h>

#include "farm/wire.h"

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
    const auto checked = check_result(result, expected, proofs);
    const auto* refusal = std::get_if<ResultRefusal>(&checked);
    return refusal == nullptr ? v1::Rejected::REASON_UNSPECIFIED : refusal->reason;
  };
  EXPECT_EQ(reason(""), v1::Rejected::REASON_UNKNOWN);
  EXPECT_EQ(reason(proofs.make("another-worker-of-it", JobId{7}, unit)),
            v1::Rejected::REASON_UNKNOWN);
  EXPECT_EQ(reason(proofs.make(expected.worker, JobId{8}, unit)), v1::Rejected::REASON_UNKNOWN);
  EXPECT_EQ(reason(proofs.make(expected.worker, JobId{7}, unit)), v1::Rejected::REASON_DAMAGED)
      << "it was looked at";
}

}  // namespace
}  // namespace hyades::coordinator
