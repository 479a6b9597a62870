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
  std::vector<Change> lively;
  for (const auto& [id, row] : now) {
    const auto [known, is_new] = known_.try_emplace(id, Known{row, step_});
    if (is_new) {
      told.push_back(row);
      continue;
    }
    Change change{id, known->second, difference(known->second.row, row)};
    if (change.fields.empty()) continue;
    if (is_lively(change.fields)) {
      lively.push_back(std::move(change));
    } else {
      tell(change, told);
    }
  }
  tell_lively(lively, told);
  std::erase_if(known_, [&](const auto& known) {
    const bool gone = !now.contains(known.first);
    if (gone) removed.push_back(known.first);
    return gone;
  });
  return told;
}

bool LiveRows::is_lively(const farm::Json& fields) const {
  return std::all_of(fields.items().begin(), fields.items().end(),
                     [&](const auto& field) { return lively_.contains(field.key()); });
}

void LiveRows::tell(Change& change, farm::Json& told) const {
  put_into(change.fields, change.known.get().row);
  change.known.get().told_in_step = step_;
  change.fields["id"] = change.id;
  told.push_back(std::move(change.fields));
}

/// As many as the budget has, those first that were told longest ago.
void LiveRows::tell_lively(std::vector<Change>& lively, farm::Json& told) const {
  std::stable_sort(lively.begin(), lively.end(), [](const Change& a, const Change& b) {
    return a.known.get().told_in_step < b.known.get().told_in_step;
  });
  size_t left = budget_;
  for (Change& change : lively) {
    tell(change, told);
    const size_t bytes = bytes_of(told.back());
    if (bytes >= left) return;
    left -= bytes;
  }
}

farm::Json LiveRows::all() const {
  farm::Json rows = farm::Json::array();
  for (const auto& [id, known] : known_) rows.push_back(known.row);
  return rows;
}

}  // namespace hyades::coordinator
