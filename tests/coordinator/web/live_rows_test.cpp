#include "coordinator/web/live_rows.h"

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

using farm::Json;

Json row(uint64_t id, const char* state, int samples) {
  return {{"id", id}, {"state", state}, {"samples", samples}};
}

TEST(LiveRows, OnlyWhatDiffersIsTold) {
  LiveRows rows({"samples"}, 1000);
  Json removed = Json::array();
  EXPECT_EQ(rows.changes({{1, row(1, "active", 0)}}, removed), Json::array({row(1, "active", 0)}));
  EXPECT_TRUE(rows.changes({{1, row(1, "active", 0)}}, removed).empty());
  EXPECT_EQ(rows.changes({{1, row(1, "active", 5)}}, removed),
            Json::parse(R"([{"samples": 5, "id": 1}])"));
  EXPECT_TRUE(removed.empty());
  EXPECT_TRUE(rows.changes({}, removed).empty());
  EXPECT_EQ(removed, Json::array({1}));
}

TEST(LiveRows, AFieldThatIsGoneIsNull) {
  LiveRows rows({}, 1000);
  Json removed = Json::array();
  Json first = row(1, "active", 0);
  first["preview"] = 7;
  (void)rows.changes({{1, first}}, removed);
  EXPECT_EQ(rows.changes({{1, row(1, "active", 0)}}, removed),
            Json::parse(R"([{"preview": null, "id": 1}])"));
  EXPECT_EQ(rows.all(), Json::array({row(1, "active", 0)}));
}

/// Whatever is told, in whatever order: who puts it together has the rows that are known, and all
/// of them come in turn.
TEST(LiveRows, ManyRowsComeInTurnAndWhatMattersAtOnce) {
  LiveRows rows({"samples"}, 400);
  Json removed = Json::array();
  LiveRows::Rows now;
  for (uint64_t id = 1; id <= 100; ++id) now[id] = row(id, "active", 0);
  std::map<uint64_t, Json> heard;
  const auto hear = [&](const Json& told) {
    for (const Json& part : told) {
      for (const auto& [name, value] : part.items()) heard[part["id"]][name] = value;
    }
  };
  hear(rows.changes(now, removed));
  std::map<uint64_t, int> times;
  for (int step = 1; step <= 60; ++step) {
    for (auto& [id, one] : now) one["samples"] = step;
    if (step == 30) now[77]["state"] = "lost";
    const Json told = rows.changes(now, removed);
    EXPECT_LT(told.dump().size(), 600U);
    if (step == 30) {
      EXPECT_EQ(told[0]["id"], 77);
      EXPECT_EQ(told[0]["state"], "lost");
    }
    for (const Json& part : told) ++times[part["id"]];
    hear(told);
  }
  ASSERT_EQ(times.size(), 100U) << "somebody was never told of";
  for (const auto& [id, count] : times) EXPECT_GE(count, 5) << id;
  for (const Json& known : rows.all()) EXPECT_EQ(heard[known["id"]], known);
}

}  // namespace
}  // namespace hyades::coordinator
