#include "coordinator/web/live_rows.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace hyades::coordinator {
namespace {

/// The fields of `now` that are not as in `before`, and null for those that are gone.
farm::Json difference(const farm::Json& before, const farm::Json& now) {
  farm::Json part = farm::Json::object();
  // Rows of one kind have their fields in one order, so that most are found at once.
  auto old = before.begin();
  for (const auto& [name, value] : now.items()) {
    auto same = old != before.end() && old.key() == name ? old : before.find(name);
    if (same == before.end() || *same != value) part[name] = value;
    if (same != before.end()) old = std::next(same);
  }
  for (const auto& [name, value] : before.items()) {
    if (!now.contains(name)) part[name] = nullptr;
  }
  return part;
}

size_t bytes_of(const farm::Json& json) {
  return json.dump(-1, ' ', false, farm::Json::error_handler_t::replace).size();
}

void put_into(const farm::Json& part, farm::Json& row) {
  for (const auto& [name, value] : part.items()) {
    if (value.is_null()) {
      row.erase(name);
    } else {
      row[name] = value;
    }
  }
}

}  // namespace

farm::Json LiveRows::changes(const Rows& now, farm::Json& removed) {
  ++step_;
  farm::Json told = farm::Json::array();
  struct Late {
    uint64_t told;
    uint64_t id;
    farm::Json part;
  };
  std::vector<Late> lively;
  for (const auto& [id, row] : now) {
    const auto found = known_.find(id);
    if (found == known_.end()) {
      known_[id] = {row, step_};
      told.push_back(row);
      continue;
    }
    Known& known = found->second;
    farm::Json part = difference(known.row, row);
    if (part.empty()) continue;
    const bool waits =
        std::all_of(part.items().begin(), part.items().end(),
                    [&](const auto& field) { return lively_.contains(field.key()); });
    if (waits) {
      lively.push_back({known.told, id, std::move(part)});
      continue;
    }
    put_into(part, known.row);
    known.told = step_;
    part["id"] = id;
    told.push_back(std::move(part));
  }
  std::stable_sort(lively.begin(), lively.end(),
                   [](const Late& a, const Late& b) { return a.told < b.told; });
  size_t left = budget_;
  for (Late& late : lively) {
    Known& known = known_[late.id];
    put_into(late.part, known.row);
    known.told = step_;
    late.part["id"] = late.id;
    const size_t bytes = bytes_of(late.part);
    told.push_back(std::move(late.part));
    if (bytes >= left) break;
    left -= bytes;
  }
  for (auto known = known_.begin(); known != known_.end();) {
    if (now.contains(known->first)) {
      ++known;
      continue;
    }
    removed.push_back(known->first);
    known = known_.erase(known);
  }
  return told;
}

farm::Json LiveRows::all() const {
  farm::Json rows = farm::Json::array();
  for (const auto& [id, known] : known_) rows.push_back(known.row);
  return rows;
}

}  // namespace hyades::coordinator
