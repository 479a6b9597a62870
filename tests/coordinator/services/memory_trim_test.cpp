// What is free goes back to the system, whatever thread had it.
#include "coordinator/services/memory_trim.h"

#include <gtest/gtest.h>

#include <barrier>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "tests/support/resident_bytes.h"

namespace hyades::coordinator {
namespace {

/// Has twelve planes of 16 MiB one after the other, as films have, and a few small things that
/// stay.
void have_films(std::vector<std::unique_ptr<int>>& stays) {
  for (int i = 0; i < 12; ++i) {
    const std::vector<std::byte> plane(size_t{16} << 20U, std::byte{1});
    stays.push_back(std::make_unique<int>(static_cast<int>(plane.size())));
  }
}

TEST(MemoryTrim, FilmsThatAreGoneLeaveNothingInTheThreadsThatHadThem) {
  return_large_blocks();
  constexpr int kThreads = 8;
  const uint64_t before = test::resident_bytes();
  std::barrier together(kThreads + 1);
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] {
      std::vector<std::unique_ptr<int>> stays;
      have_films(stays);
      together.arrive_and_wait();
      together.arrive_and_wait();
    });
  }
  together.arrive_and_wait();
  const uint64_t after = test::resident_bytes();
  together.arrive_and_wait();
  for (std::thread& thread : threads) thread.join();
  EXPECT_LT(after, before + (uint64_t{16} << 20U));
}

}  // namespace
}  // namespace hyades::coordinator
