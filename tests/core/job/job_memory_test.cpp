// What a job is said to take in memory, against what malloc has given for it.
#include "core/job/job_memory.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <functional>
#include <memory>
#include <string>

#include "core/job/parse.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// Bytes that malloc has given; 0 where a sanitizer stands in its place.
uint64_t given() {
  const struct mallinfo2 now = mallinfo2();
  return now.uordblks + now.hblkhd;
}

/// A job with so many entries, each as `entry` says of its name, below `head`.
std::string document(const std::string& head, int count,
                     const std::function<std::string(const std::string&)>& entry) {
  std::string text = "hyades: 1\n" + head;
  for (int i = 0; i < count; ++i) text += "  " + entry("thing-number-" + std::to_string(i)) + "\n";
  return text;
}

/// What is told of the job over what it takes.
double told_over_taken(const std::string& text) {
  MemoryAssets assets;
  assets.add("a-mesh-with-a-long-name.obj", "v 0 0 0\n");
  Diagnostics diagnostics;
  const uint64_t before = given();
  const auto job = std::make_unique<const Job>(parse_job(text, "job.yaml", assets, diagnostics));
  const uint64_t after = given();
  EXPECT_TRUE(diagnostics.empty()) << diagnostics.to_string().substr(0, 200);
  return static_cast<double>(memory_of(*job)) / static_cast<double>(after - before);
}

TEST(JobMemory, IsThatWhichMallocHasGiven) {
  if (given() == 0) GTEST_SKIP() << "malloc tells nothing here";
  const std::string objects = "materials: {clay: {type: lambert}}\nobjects:\n";
  const auto measured = [](const std::string& head, int count, const std::string& value) {
    return told_over_taken(
        document(head, count, [&](const std::string& name) { return name + ": " + value; }));
  };
  (void)measured(objects, 10, "{shape: sphere, radius: = 1 + t}");  // what is made once
  const std::pair<const char*, double> told[] = {
      {"spheres", measured(objects, 2000, "{shape: sphere, radius: 2, material: clay}")},
      {"lamps",
       measured(objects, 2000, "{shape: rectangle, emit: {color: [1, 0.5, 1], power: 3}}")},
      {"meshes", measured(objects, 2000, "{mesh: a-mesh-with-a-long-name.obj}")},
      {"groups",
       measured(objects, 1000, "{group: {objects: {a: {shape: sphere}, b: {shape: box}}}}")},
      {"steps", measured(objects, 1000, "{shape: box, transform: [{rotate_x: 1}, {rotate_y: 2}]}")},
      {"keys",
       measured(objects, 1000, "{shape: sphere, at: {keys: {1: [1, 2, 3], 9: [3, 4, 5]}}}")},
      {"overrides", measured(objects, 1000, "{shape: box, override: {clay: clay}}")},
      {"expressions", measured(objects, 1000, "{shape: sphere, radius: = 1 + t, at: [= t, 0, 0]}")},
      {"materials", measured("materials:\n", 1000, "{type: principled, base_color: 0.2}")},
      {"textures", measured("textures:\n  clay: {type: checker}\n", 1000,
                            "{type: ramp, input: clay, stops: {0: 0, 0.5: 1, 1: 0}}")},
      {"lights", measured("lights:\n", 1000, "{type: point, at: [1, 2, 3], power: 4}")},
      {"media", measured("media:\n", 1000, "{absorption: 1, scattering: 2}")},
  };
  for (const auto& [what, ratio] : told) {
    EXPECT_GT(ratio, 0.9) << what;
    EXPECT_LT(ratio, 1.2) << what;
  }
}

TEST(JobMemory, OfAShortTextWithAliasesIsThatOfALongOne) {
  std::string text = document("objects:\n", 500, [](const std::string& name) {
    return name + ": {shape: sphere, transform: *many}";
  });
  std::string steps;
  for (int i = 0; i < 100; ++i) steps += "{rotate_x: 1},";
  const std::string first = "objects:\n";
  text.insert(text.find(first) + first.size(),
              "  first: {shape: sphere, transform: &many [" + steps + "]}\n");
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job(text, "job.yaml", assets, diagnostics);
  ASSERT_TRUE(diagnostics.empty()) << diagnostics.to_string();
  EXPECT_LT(text.size(), 40'000U);
  EXPECT_GT(memory_of(job), 30'000'000U);
}

}  // namespace
}  // namespace hyades::core
