#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/client/failure.h"
#include "cli/client/trace_writer.h"
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

constexpr int64_t kEpochMs = 1'700'000'000'000;
constexpr int kTile = 16;
constexpr int kFrameEdge = 48;     // pixels: nine tiles
constexpr uint32_t kSamples = 40;  // two batches and a half

v1::Job job_of(uint32_t frames) {
  v1::Job job;
  job.set_id(1);
  job.set_name("walk");
  job.set_frames(frames);
  job.set_samples(uint64_t{frames} * kFrameEdge * kFrameEdge * kSamples);
  job.set_state(v1::JOB_STATE_DONE);
  job.set_submitted_ms(kEpochMs);
  job.set_ended_ms(kEpochMs + 3'600'000);
  return job;
}

/// What is done for some frames by two workers with two threads each, one of which does not tell
/// its threads. Films come late by turns, so that what is told of a thread overlaps.
void do_frames(int32_t frames, const std::function<void(const v1::TimelineStep&)>& take) {
  uint64_t number = 0;
  int64_t now = kEpochMs * 1000;
  v1::TimelineStep step;
  const auto tell = [&](v1::TimelineStep::Kind kind, int64_t took) {
    step.set_number(++number);
    step.set_kind(kind);
    step.set_begun_us(now - took);
    step.set_ended_us(now);
    take(step);
  };
  for (int32_t frame = 1; frame <= frames; ++frame) {
    step.mutable_unit()->set_frame(frame);
    for (uint32_t batch = 0; batch < 3; ++batch) {
      for (int tile = 0; tile < 9; ++tile) {
        const int x = tile % 3 * kTile;
        const int y = tile / 3 * kTile;
        v1::PixelRect& rect = *step.mutable_unit()->mutable_tile();
        rect.set_x0(x);
        rect.set_y0(y);
        rect.set_x1(x + kTile);
        rect.set_y1(y + kTile);
        step.mutable_unit()->set_first_batch(batch);
        step.mutable_unit()->set_batches(1);
        now += 10'000;
        step.set_worker(tile % 2 == 0 ? "north" : "south");
        step.set_thread(tile % 2 == 0 ? static_cast<uint32_t>(tile / 2 % 2 + 1) : 0);
        tell(v1::TimelineStep::KIND_RENDER, 38'000 + tile % 3 * 1'000);
        step.clear_worker();
        step.set_thread(0);
        tell(v1::TimelineStep::KIND_MERGE, 200);
      }
    }
    now += 5'000;
    tell(v1::TimelineStep::KIND_FINISH, 4'000);
  }
}

/// What must hold of every trace.
struct Checked {
  uint64_t samples = 0;
  std::map<std::string, int> slices;     ///< by category
  std::map<int, std::string> processes;  ///< names
  std::map<std::pair<int, int>, std::string> threads;
  std::vector<json> instants;
  uint64_t counted = 0;  ///< samples of all counters
};

Checked check(const json& trace) {
  Checked checked;
  std::map<std::pair<int, int>, std::vector<std::pair<int64_t, int64_t>>> busy;
  for (const json& event : trace.at("traceEvents")) {
    const std::string phase = event.at("ph");
    const int pid = event.at("pid");
    if (phase == "M") {
      const std::string name = event.at("args").at("name");
      if (event.at("name") == "process_name") {
        EXPECT_TRUE(checked.processes.emplace(pid, name).second) << "named twice: " << name;
      } else {
        EXPECT_TRUE(
            checked.threads.emplace(std::pair(pid, event.at("tid").get<int>()), name).second);
      }
      continue;
    }
    const int64_t begin = event.at("ts");
    if (phase == "X") {
      const int64_t length = event.at("dur");
      EXPECT_GE(length, 0) << event;
      busy[{pid, event.at("tid").get<int>()}].push_back({begin, begin + length});
      ++checked.slices[event.at("cat")];
      if (event.at("cat") == "render")
        checked.samples += event.at("args").at("samples").get<uint64_t>();
    } else if (phase == "C") {
      checked.counted += event.at("args").at("samples/s").get<uint64_t>();
    } else {
      EXPECT_EQ(phase, "i");
      checked.instants.push_back(event);
    }
  }
  for (auto& [thread, slices] : busy) {
    EXPECT_TRUE(checked.threads.contains(thread)) << "a thread without a name";
    EXPECT_TRUE(checked.processes.contains(thread.first)) << "a process without a name";
    std::sort(slices.begin(), slices.end());
    for (size_t i = 1; i < slices.size(); ++i) {
      EXPECT_LE(slices[i - 1].second, slices[i].first) << "two slices of a thread at once";
    }
  }
  return checked;
}

TEST(Trace, SlicesAreInOrderAndSamplesAreThoseOfTheJob) {
  const v1::Job job = job_of(4);
  std::ostringstream out;
  TraceWriter writer(out, job);
  do_frames(4, [&](const v1::TimelineStep& step) { writer.take(step); });
  v1::LogLine line;
  line.set_time_ms(kEpochMs + 50);
  line.set_level(v1::LOG_LEVEL_WARNING);
  line.set_worker("south");
  line.set_text("south is gone, its units are leased again \xFF");
  writer.take(line);
  writer.end(job);
  const json trace = json::parse(out.str());
  const Checked checked = check(trace);
  EXPECT_EQ(checked.samples, job.samples());
  EXPECT_EQ(checked.counted, job.samples());
  EXPECT_EQ(checked.slices.at("render"), 4 * 27);
  EXPECT_EQ(checked.slices.at("merge"), 4 * 27);
  EXPECT_EQ(checked.slices.at("finish"), 4);
  EXPECT_EQ(checked.slices.at("job"), 1);
  ASSERT_EQ(checked.processes.size(), 3U);
  EXPECT_EQ(checked.processes.at(1), "coordinator");
  EXPECT_EQ(checked.processes.at(2), "worker north");
  EXPECT_EQ(checked.threads.at({2, 2}), "thread 2");
  ASSERT_EQ(checked.instants.size(), 1U);
  EXPECT_EQ(checked.instants[0].at("pid"), 3);
  EXPECT_EQ(checked.instants[0].at("ts"), 50'000);
  EXPECT_EQ(trace.at("otherData").at("samples_are_exact"), true);
}

TEST(Trace, WithoutAFinishedFrameTheLastBatchCountsAsAWholeOne) {
  std::ostringstream out;
  const v1::Job job = job_of(4);
  TraceWriter writer(out, job);
  do_frames(1, [&](const v1::TimelineStep& step) {
    if (step.kind() == v1::TimelineStep::KIND_RENDER) writer.take(step);
  });
  writer.end(job);
  const json trace = json::parse(out.str());
  EXPECT_EQ(check(trace).samples, uint64_t{kFrameEdge} * kFrameEdge * 48);
  EXPECT_EQ(trace.at("otherData").at("samples_are_exact"), false);
}

TEST(Trace, AFrameOfWhichUnitsAreNotKnownTeachesNothing) {
  std::ostringstream out;
  const v1::Job job = job_of(4);
  TraceWriter writer(out, job);
  int left_out = 10;
  do_frames(4, [&](const v1::TimelineStep& step) {
    if (--left_out < 0) writer.take(step);
  });
  writer.end(job);
  const json trace = json::parse(out.str());
  // Five units of 16 x 16 pixels and 16 samples have not come.
  EXPECT_EQ(check(trace).samples, job.samples() - 5 * 16 * 16 * 16);
  EXPECT_EQ(trace.at("otherData").at("samples_are_exact"), true);
}

TEST(Trace, WorkersOfOneNameKeepTheirTimes) {
  std::ostringstream out;
  TraceWriter writer(out, job_of(1));
  v1::TimelineStep step;
  step.set_kind(v1::TimelineStep::KIND_RENDER);
  step.set_worker("north");
  step.set_thread(1);
  for (uint64_t i = 0; i < 10; ++i) {
    step.set_number(i + 1);
    const int64_t begun = kEpochMs * 1000 + static_cast<int64_t>(i / 2) * 1'000'000;
    step.set_begun_us(begun + static_cast<int64_t>(i % 2) * 1000);
    step.set_ended_us(begun + 900'000 + static_cast<int64_t>(i % 2) * 1000);
    writer.take(step);
  }
  writer.end(job_of(1));
  const json trace = json::parse(out.str());
  check(trace);
  std::set<int> threads;
  for (const json& event : trace.at("traceEvents")) {
    if (event.at("ph") != "X" || event.at("cat") != "render") continue;
    EXPECT_EQ(event.at("dur"), 900'000);
    threads.insert(event.at("tid").get<int>());
  }
  EXPECT_EQ(threads.size(), 2U);
}

TEST(Trace, AMillionUnitsGoThrough) {
  /// Counts what is written and forgets it.
  class Counter : public std::streambuf {
   public:
    uint64_t bytes = 0;

   protected:
    int overflow(int c) override {
      ++bytes;
      return c;
    }
    std::streamsize xsputn(const char*, std::streamsize n) override {
      bytes += static_cast<uint64_t>(n);
      return n;
    }
  };
  const auto peak_kib = [] {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmHWM:")) return std::stol(line.substr(6));
    }
    return 0L;
  };
  Counter counter;
  std::ostream out(&counter);
  const v1::Job job = job_of(40'000);
  TraceWriter writer(out, job);
  long before = 0;
  do_frames(40'000, [&](const v1::TimelineStep& step) {
    writer.take(step);
    if (step.number() == 50'000) before = peak_kib();
  });
  writer.end(job);
  EXPECT_EQ(writer.units(), 40'000U * 27);
  EXPECT_EQ(writer.samples(), job.samples());
  EXPECT_GT(counter.bytes, 100'000'000U);
  EXPECT_LT(peak_kib() - before, 8 * 1024);
}

TEST(Trace, TheCommandBringsAllPagesAndTheLog) {
  const TempFolder folder;
  FakeFarm farm;
  farm.jobs.push_back(job_of(40));
  do_frames(40, [&](const v1::TimelineStep& step) { farm.steps.push_back(step); });
  farm.dropped_steps = 7;
  const std::string file = folder.file("trace.json");
  const Ran ran = run(trace_command, {"walk", "-o", file, "--coordinator", farm.address()});
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_THAT(ran.err, testing::HasSubstr("7 older steps are not kept"));
  EXPECT_THAT(ran.err, testing::HasSubstr("1080 units of job 1"));
  const Checked checked = check(json::parse(std::ifstream(file)));
  EXPECT_EQ(checked.samples, farm.jobs[0].samples());
  EXPECT_EQ(checked.slices.at("finish"), 40);
  EXPECT_EQ(checked.instants.size(), 3U);
}

TEST(Trace, AFileThatCannotBeWrittenIsAFailure) {
  FakeFarm farm;
  farm.jobs.push_back(job_of(1));
  const Ran ran = run(trace_command,
                      {"walk", "-o", "/nonexistent/trace.json", "--coordinator", farm.address()});
  EXPECT_THAT(ran.err, testing::HasSubstr("cannot write /nonexistent/trace.json"));
  EXPECT_EQ(ran.status, kFailed);
}

}  // namespace
}  // namespace hyades::cli
