#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "farm/json_form.h"

namespace hyades::coordinator {

/// The rows of a list (workers, jobs) as those who are told of its changes know them.
///
/// Of a row that has changed only the fields that differ are told. Fields that always change
/// (samples done, speeds) wait where there are many rows: each time as many bytes of them are told
/// as `budget` has, those first that were told longest ago. So the bytes of a second are bounded,
/// however many rows there are, and nothing that matters waits.
class LiveRows {
 public:
  using Rows = std::map<uint64_t, farm::Json>;

  /// `lively`: the fields that always change; `budget`: bytes of them that are told each time.
  LiveRows(std::set<std::string> lively, size_t budget)
      : lively_(std::move(lively)), budget_(budget) {}

  /// What is to be told now that the list is `now`: rows that are new whole, of others `id` and
  /// what has changed (null for a field that is gone). What is told is known from then on. The ids
  /// of rows that are not there any more go to `removed`.
  farm::Json changes(const Rows& now, farm::Json& removed);
  /// All rows, whole, as they are known.
  farm::Json all() const;
  /// Calls `visit(id, row)` for each row as it is known.
  template <class Visit>
  void each(const Visit& visit) const {
    for (const auto& [id, known] : known_) visit(id, known.row);
  }
  /// Nothing is known any more: all rows are new then.
  void clear() { known_.clear(); }

 private:
  struct Known {
    farm::Json row;
    uint64_t told_in_step = 0;  ///< the last one in which a change of it was told
  };
  struct Change {
    uint64_t id;
    std::reference_wrapper<Known> known;
    farm::Json fields;  ///< that have changed
  };
  bool is_lively(const farm::Json& fields) const;
  void tell(Change& change, farm::Json& told) const;
  void tell_lively(std::vector<Change>& lively, farm::Json& told) const;

  std::set<std::string> lively_;
  size_t budget_;
  uint64_t step_ = 0;  ///< how often changes() was called
  std::map<uint64_t, Known> known_;
};

}  // namespace hyades::coordinator
