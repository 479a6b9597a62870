#include "core/base/parallel.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace hyades::core {
namespace {

TEST(Parallel, VisitsEachIndexOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    for (const size_t count : {0, 1, 2, 3, 1000}) {
      for (const size_t grain : {0, 1, 7, 5000}) {
        std::vector<std::atomic<int>> visits(count);
        const Status status = parallel_for(
            count, threads, [&](size_t i) { ++visits[i]; }, grain);
        EXPECT_TRUE(status);
        for (const auto& n : visits) EXPECT_EQ(n, 1);
      }
    }
  }
}

TEST(Parallel, FlushesDenormalsInEveryThreadAndRestores) {
  const unsigned before = _mm_getcsr();
  std::atomic<int> wrong{0};
  EXPECT_TRUE(parallel_for(64, 4, [&](size_t) {
    if ((_mm_getcsr() & 0x8040U) != 0x8040U) ++wrong;
  }));
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(_mm_getcsr(), before);
}

TEST(Parallel, ContainersLimitThreads) {
  EXPECT_EQ(parse_cpu_quota("max 100000"), std::nullopt);
  EXPECT_EQ(parse_cpu_quota("200000 100000"), 2);
  EXPECT_EQ(parse_cpu_quota("150000 100000"), 2);
  EXPECT_EQ(parse_cpu_quota("5000 100000"), 1);
  for (const char* wrong :
       {"", "7", "0 100000", "-5 100000", "100000 0", "99999999999999999999 1"}) {
    EXPECT_EQ(parse_cpu_quota(wrong), std::nullopt) << wrong;
  }
  EXPECT_GE(hardware_threads(), 1);
}

TEST(Parallel, TheLowestExceptionBecomesTheError) {
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Status status = parallel_for(200, 4, [](size_t i) {
      if (i >= 20 && i % 5 == 0) throw std::runtime_error("index " + std::to_string(i));
    });
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().message, "index 20");
  }
  const Status odd = parallel_for(1, 1, [](size_t) { throw 7; });
  ASSERT_FALSE(odd);
  EXPECT_EQ(odd.error().message, "unknown exception");
}

}  // namespace
}  // namespace hyades::core
