// What `hyades top` shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "cli/client/show.h"
#include "cli/client/top_page.h"

namespace hyades::cli {
namespace {

int columns_of(const std::string& line) {
  return static_cast<int>(std::count_if(line.begin(), line.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

FarmNow farm(int jobs, int workers) {
  FarmNow now;
  now.time_ms = 1'700'000'000'000;
  for (int i = 1; i <= jobs; ++i) {
    v1::Job job;
    job.set_id(static_cast<uint64_t>(i));
    job.set_name("job-" + std::to_string(i));
    job.set_state(v1::JOB_STATE_RUNNING);
    job.set_samples(100);
    job.set_samples_done(25);
    job.set_frames(4);
    job.set_seconds_left(-1);
    now.jobs.push_back(job);
  }
  for (int i = 1; i <= workers; ++i) {
    v1::Worker worker;
    worker.set_id(static_cast<uint64_t>(i));
    worker.set_name("star-" + std::to_string(i));
    worker.set_state(v1::WORKER_STATE_ACTIVE);
    worker.set_threads(8);
    now.workers.push_back(worker);
  }
  return now;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

TEST(Top, FitsEveryTerminal) {
  for (const int width : {1, 20, 80, 200}) {
    for (const int height : {1, 5, 24, 60}) {
      for (const int jobs : {0, 3, 100}) {
        for (const int workers : {0, 2, 500}) {
          const auto lines = top_page(farm(jobs, workers), "farm:7700", width, height, false);
          ASSERT_LE(static_cast<int>(lines.size()), height);
          for (const std::string& line : lines) ASSERT_EQ(columns_of(line), width) << line;
        }
      }
    }
  }
}

TEST(Top, WhatDoesNotFitIsCounted) {
  const std::string page = joined(top_page(farm(100, 500), "farm:7700", 120, 45, false));
  // 40 rows for both: 20 of jobs, of which the last counts.
  EXPECT_NE(page.find("and 81 more"), std::string::npos) << page;
  EXPECT_NE(page.find("and 481 more"), std::string::npos) << page;
}

TEST(Top, AJobIsShownWithItsBarAndShare) {
  const std::string page = joined(top_page(farm(1, 0), "farm:7700", 160, 20, false));
  EXPECT_NE(page.find("███░░░░░░░░░"), std::string::npos) << page;
  EXPECT_NE(page.find("25.0 %"), std::string::npos);
  EXPECT_NE(page.find("no worker is there"), std::string::npos);
}

TEST(Top, NamesCannotSpeakToTheTerminal) {
  FarmNow now = farm(1, 1);
  now.jobs[0].set_name("evil\033[2J\nname");
  now.workers[0].set_name("a\rb");
  const std::string page = joined(top_page(now, "farm:7700", 160, 20, false));
  EXPECT_EQ(page.find('\033'), std::string::npos);
  EXPECT_EQ(page.find('\r'), std::string::npos);
}

TEST(Top, ColoursOnlyWhereTheyAreWanted) {
  EXPECT_EQ(joined(top_page(farm(2, 2), "f:1", 80, 20, false)).find('\033'), std::string::npos);
  EXPECT_NE(joined(top_page(farm(2, 2), "f:1", 80, 20, true)).find('\033'), std::string::npos);
}

TEST(Top, AJobThatNobodyRendersWaitsAndSaysWhy) {
  FarmNow now = farm(2, 0);
  now.jobs[0].set_leased(2);
  now.jobs[1].set_waiting(true);
  now.jobs[1].set_reason("it asks for workers with the tag 'gpu', and none is there");
  const std::string page = joined(top_page(now, "farm:7700", 160, 20, false));
  EXPECT_NE(page.find("running"), std::string::npos) << page;
  EXPECT_NE(page.find("waiting"), std::string::npos) << page;
  EXPECT_NE(page.find("it asks for workers with the tag 'gpu'"), std::string::npos) << page;
}

TEST(Top, SpeedsAreToldWhole) {
  FarmNow now = farm(1, 2);
  now.jobs[0].set_samples_per_second(868'123);
  now.workers[0].set_samples_per_second(860'000);
  now.workers[1].set_samples_per_second(940'000);
  const std::string page = joined(top_page(now, "farm:7700", 160, 20, false));
  for (const char* told : {"868 ksamples/s", "860 ksamples/s", "16 threads, 1.80 Msamples/s"}) {
    EXPECT_NE(page.find(told), std::string::npos) << told << "\n" << page;
  }
}

TEST(Top, WorkersAreInOrderOfTheirNames) {
  const std::string page = joined(top_page(farm(0, 12), "farm:7700", 160, 30, false));
  EXPECT_LT(page.find("star-9 "), page.find("star-10 ")) << page;
}

TEST(Names, DigitsAreNumbers) {
  for (const auto& [a, b] :
       {std::pair("w9", "w10"), std::pair("w1", "w1a"), std::pair("a2b10", "a02b11"),
        std::pair("", "a"), std::pair("w01", "w1"), std::pair("a", "b1")}) {
    EXPECT_TRUE(is_before(a, b)) << a << " " << b;
    EXPECT_FALSE(is_before(b, a)) << a << " " << b;
  }
  EXPECT_FALSE(is_before("w7", "w7"));
}

}  // namespace
}  // namespace hyades::cli
