#include "farm/retry_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "farm/last_words.h"
#include "farm/thread_pool.h"

namespace hyades::farm {
namespace {

TEST(RetryQueue, OfOneOwnerKeepTheirOrderWhileOthersGoOn) {
  std::mutex mutex;
  std::vector<int> done;
  std::atomic<bool> full{true};
  const auto note = [&](int what) {
    const std::lock_guard lock(mutex);
    done.push_back(what);
    return true;
  };
  RetryQueue queue(2);
  std::promise<void> other;
  queue.add(1, [&] { return !full && note(1); });
  queue.add(3, [&] { return !full; });  // as many as there are threads
  for (int i = 2; i <= 50; ++i) queue.add(1, [&, i] { return note(i); });
  queue.add(2, [&] {
    other.set_value();
    return true;
  });
  ASSERT_EQ(other.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready)
      << "it waits for a task that cannot be done";
  {
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(done.empty());
  }
  full = false;
  std::promise<void> last;
  queue.add(1, [&] {
    last.set_value();
    return true;
  });
  ASSERT_EQ(last.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
  ASSERT_EQ(done.size(), 50U);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(done[static_cast<size_t>(i)], i + 1);
}

TEST(RetryQueue, OwnersTakeTurnsByTheTimeThatTheirsTakes) {
  std::mutex mutex;
  std::vector<std::string> done;
  std::atomic<int> of_eve{0};
  std::atomic<int> most_of_eve{0};
  {
    RetryQueue queue(2);
    for (uint64_t key = 1; key <= 6; ++key) {
      queue.add(
          key,
          [&] {
            most_of_eve = std::max(most_of_eve.load(), ++of_eve);
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            --of_eve;
            const std::lock_guard lock(mutex);
            done.emplace_back("eve");
            return true;
          },
          "eve");
    }
    for (uint64_t key = 7; key <= 9; ++key) {
      queue.add(
          key,
          [&] {
            const std::lock_guard lock(mutex);
            done.emplace_back("ann");
            return true;
          },
          "ann");
    }
  }
  ASSERT_EQ(done.size(), 9U);
  EXPECT_EQ(most_of_eve, 1) << "one of each owner is done at a time";
  EXPECT_EQ(std::vector<std::string>(done.begin(), done.begin() + 3),
            std::vector<std::string>(3, "ann"));
}

/// Tasks of eve's that do not end keep no others from being done, however many there are.
TEST(RetryQueue, OfOneOwnerHaveNoMoreThreadsThanTheyMay) {
  std::promise<void> go;
  const std::shared_future<void> gone = go.get_future().share();
  std::atomic<int> begun{0};
  std::promise<void> other;
  RetryQueue queue(3, std::chrono::seconds(1), 2);
  for (uint64_t key = 1; key <= 5; ++key) {
    queue.add(
        key,
        [&, gone] {
          ++begun;
          gone.wait();
          return true;
        },
        "eve");
  }
  while (begun < 2) std::this_thread::yield();
  queue.add(
      6,
      [&] {
        other.set_value();
        return true;
      },
      "ann");
  EXPECT_EQ(other.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
  EXPECT_EQ(begun, 2);
  go.set_value();
  queue.end();
  EXPECT_EQ(begun, 5);
}

TEST(FairShares, WhatWasLongAgoCountsLess) {
  using std::chrono::minutes;
  const FairShares::Time now;
  FairShares shares;
  shares.use("eve", 8, now);
  shares.use("ann", 3, now + minutes(20));
  EXPECT_DOUBLE_EQ(shares.used("eve", now), 8);
  EXPECT_DOUBLE_EQ(shares.used("eve", now + minutes(20)), 2);
  EXPECT_DOUBLE_EQ(shares.used("ann", now + minutes(20)), 3);
  EXPECT_DOUBLE_EQ(shares.used("nobody", now), 0);
  shares.use("eve", 1, now + minutes(20));
  EXPECT_DOUBLE_EQ(shares.used("eve", now + minutes(20)), 3);
  for (int i = 0; i < 2000; ++i) shares.use(std::to_string(i), 0.1, now + minutes(20));
  EXPECT_DOUBLE_EQ(shares.used("eve", now + minutes(20)), 3) << "who has used much is remembered";
}

TEST(FairShares, NextIsTheFirstWhoseOwnerHasUsedLeast) {
  const FairShares::Time now;
  FairShares shares;
  shares.use("eve", 8, now);
  shares.use("ann", 3, now);
  shares.use("bob", 3, now);
  const auto next = [&](const std::vector<std::string>& waiting, const std::string& may_not = {}) {
    const auto found =
        shares.next(waiting.begin(), waiting.end(), now,
                    [&](const std::string& owner) { return owner == may_not ? nullptr : &owner; });
    return found - waiting.begin();
  };
  EXPECT_EQ(next({"eve", "bob", "ann", "eve"}), 1);
  EXPECT_EQ(next({"eve", "bob", "ann", "eve"}, "bob"), 2);
  EXPECT_EQ(next({"ann", "new", "other"}), 1) << "who has used nothing";
  EXPECT_EQ(next({"eve", "eve"}, "eve"), 2) << "none";
  EXPECT_EQ(next({}), 0);
}

TEST(RetryQueue, AreTriedOnceMoreInTheEnd) {
  int tried = 0;
  int after = 0;
  int done = 0;
  {
    RetryQueue queue(1);
    queue.add(1, [&] { return ++tried > 100; });
    queue.add(1, [&] { return ++after > 0; });
    for (uint64_t owner = 2; owner < 10; ++owner) queue.add(owner, [&] { return ++done > 0; });
  }
  EXPECT_GE(tried, 1);
  EXPECT_LE(tried, 2);
  EXPECT_EQ(after, 0) << "what comes after something that was not done";
  EXPECT_EQ(done, 8);
}

TEST(RetryQueue, WhatIsNeverDoneComesAgainUntilTheEnd) {
  std::atomic<int> rounds{0};
  std::promise<void> third;
  RetryQueue queue(1, std::chrono::milliseconds(1));
  queue.add(1, [&] {
    if (++rounds == 3) third.set_value();
    return false;
  });
  ASSERT_EQ(third.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
  queue.end();
  const int last = rounds;
  queue.add(1, [&] { return ++rounds > 0; });
  EXPECT_EQ(rounds, last) << "nothing is done after the end";
}

TEST(RetryQueueDeathTest, WithoutMemoryTheProcessSaysSoAndEnds) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        farm::die_with_words("hyades coordinator", "start it again");
        RetryQueue queue(1);
        queue.add(1, []() -> bool { throw std::bad_alloc(); });
      },
      "hyades coordinator stops: it has no memory left; start it again");
}

TEST(ThreadPool, TakeNoMoreThanMayWait) {
  std::promise<void> go;
  const std::shared_future<void> gone = go.get_future().share();
  std::atomic<int> done{0};
  {
    ThreadPool pool(2, 3);
    std::atomic<int> begun{0};
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(pool.submit([&, gone] {
        ++begun;
        gone.wait();
        ++done;
      }));
    }
    while (begun < 2) std::this_thread::yield();
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(pool.submit([&] { ++done; }));
    EXPECT_FALSE(pool.submit([&] { ++done; }));
    go.set_value();
  }
  EXPECT_EQ(done, 5) << "all that was taken is done, and nothing else";
}

TEST(ThreadPool, TakesTurnsBetweenOwners) {
  std::promise<void> go;
  const std::shared_future<void> gone = go.get_future().share();
  std::string order;
  {
    ThreadPool pool(1, 8);
    std::atomic<bool> begun{false};
    ASSERT_TRUE(pool.submit([&, gone] {
      begun = true;
      gone.wait();
    }));
    while (!begun) std::this_thread::yield();
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(pool.submit([&] { order += 'v'; }, "vic"));
    EXPECT_FALSE(pool.submit([&] { order += 'v'; }, "vic")) << "half of what may wait";
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(pool.submit([&] { order += 'b'; }, "bob"));
    go.set_value();
  }
  EXPECT_EQ(order, "vbvbvv");
}

TEST(ThreadPool, LeavesThreadsToOthers) {
  std::promise<void> go;
  const std::shared_future<void> gone = go.get_future().share();
  std::atomic<int> begun{0};
  std::promise<void> other;
  {
    ThreadPool pool(3, 8, 2);
    for (int i = 0; i < 4; ++i) {
      ASSERT_TRUE(pool.submit(
          [&, gone] {
            ++begun;
            gone.wait();
          },
          "vic"));
    }
    while (begun < 2) std::this_thread::yield();
    ASSERT_TRUE(pool.submit([&] { other.set_value(); }, "bob"));
    EXPECT_EQ(other.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
    EXPECT_EQ(begun, 2);
    go.set_value();
  }
  EXPECT_EQ(begun, 4) << "all that was taken is done";
}

}  // namespace
}  // namespace hyades::farm
