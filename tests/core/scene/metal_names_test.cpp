#include <gtest/gtest.h>

#include <algorithm>

#include "core/job/metal_names.h"
#include "core/materials/make_material.h"

namespace hyades::core {
namespace {

TEST(MetalNames, OfJobsAreThoseOfTheTable) {
  std::vector<std::string> table = metal_names();
  std::sort(table.begin(), table.end());
  EXPECT_EQ(metal_names_in_jobs(), table);
}

}  // namespace
}  // namespace hyades::core
