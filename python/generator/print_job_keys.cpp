// Prints every key of a job with what it takes, as the reader of jobs lists them: JSON, a key a
// line.

#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/job/key_listing.h"

namespace {

using hyades::core::KeyFacts;
using hyades::core::ListedKey;
using hyades::core::Range;
using nlohmann::ordered_json;

void add_range(ordered_json& json, const Range& range) {
  if (range.low != hyades::core::kAnyNumber.low) json["low"] = range.low;
  if (range.low_open) json["above"] = true;
  if (range.high != hyades::core::kAnyNumber.high) json["high"] = range.high;
  if (range.high_open) json["below"] = true;
  if (*range.unit != '\0') json["unit"] = range.unit;
}

ordered_json to_json(const ListedKey& key) {
  const KeyFacts& facts = key.facts;
  ordered_json json = {
      {"type", key.type}, {"section", key.id.section}, {"key", key.id.key}, {"takes", facts.takes}};
  if (facts.required) json["required"] = true;
  if (!facts.start.empty()) json["default"] = ordered_json::parse(facts.start);
  add_range(json, facts.range);
  if (!facts.names.empty()) json["names"] = facts.names;
  if (!facts.below.empty()) json["map"] = facts.below;
  return json;
}

}  // namespace

int main() {
  const char* comma = "[";
  for (const ListedKey& key : hyades::core::listed_job_keys()) {
    std::printf("%s\n%s", comma, to_json(key).dump().c_str());
    comma = ",";
  }
  std::printf("\n]\n");
}
