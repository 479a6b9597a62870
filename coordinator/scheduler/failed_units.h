#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "coordinator/scheduler/ids.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// A unit within its frame: a tile by its index in the grid.
struct Extent {
  uint32_t tile = 0;
  core::BatchRange batches;
  friend bool operator==(const Extent&, const Extent&) = default;
};

/// Whether a worker may try a unit that has failed with these workers (sorted, each once), and
/// about which these witnesses have said what they think.
using MayTry = std::function<bool(const std::vector<WorkerId>&, const std::vector<Witness>&)>;

/// The units of a frame that have failed: with whom, and which of them wait for another try. A
/// worker can have very many fail at once, so that no step walks through all of them: those that
/// failed with the same workers are one group, as the same others may try them.
class FailedUnits {
 public:
  /// The worker, of this witness, could not render the unit, which does not wait.
  void blame(const Extent& e, WorkerId worker, Witness witness);
  /// With whom the unit has failed, sorted, each once.
  const std::vector<WorkerId>& workers(const Extent& e) const;
  /// The witnesses of those with whom it has failed, each once.
  std::vector<Witness> witnesses(const Extent& e) const;
  /// How often it has failed.
  size_t failures(const Extent& e) const;
  /// Forgets that a unit, which does not wait, has failed; says with whom it had.
  std::vector<WorkerId> forgive(const Extent& e);

  /// Whether it has failed.
  bool contains(const Extent& e) const { return units_.contains(key(e)); }

  // Those that wait for another try: none overlaps another.

  /// The unit, which has failed, waits from now on, if it does not yet.
  void wait(const Extent& e);
  bool waits(const Extent& e) const;
  bool any_waits() const { return !waiting_.empty(); }
  /// Batches of all that wait.
  uint64_t waiting_batches() const { return waiting_batches_; }
  /// The one that has waited longest of those that `may_try` lets be tried; asks once for each
  /// group at most.
  std::optional<Extent> first(const MayTry& may_try) const;
  /// Units that overlap this one wait no longer; says which these are.
  std::vector<Extent> take_overlapping(const Extent& e);
  /// All that wait, in order.
  std::vector<Extent> waiting() const;

 private:
  /// Tile, first batch and number of batches.
  using Key = std::tuple<uint32_t, uint32_t, uint32_t>;
  static Key key(const Extent& e) { return {e.tile, e.batches.first, e.batches.count}; }

  /// Units that have failed with the same workers.
  struct Group {
    size_t units = 0;                    ///< that are of it
    std::map<uint64_t, Extent> waiting;  ///< those that wait, by serial
  };
  using Groups = std::map<std::vector<WorkerId>, Group>;
  struct Unit {
    Groups::iterator group;
    std::vector<Witness> witnesses;  ///< each once
    size_t failures = 0;
    uint64_t serial = 0;  ///< by which it waits; 0: it does not
  };
  using Units = std::map<Key, Unit>;

  void leave(Groups::iterator group);
  void stop_waiting(Unit& unit, const Extent& e);

  Groups groups_;
  Units units_;
  std::map<uint64_t, Groups::const_iterator> by_age_;  ///< groups by who waits longest of each
  std::map<Key, Extent> waiting_;                      ///< by place
  uint64_t waiting_batches_ = 0;
  uint64_t next_serial_ = 1;
};

}  // namespace hyades::coordinator
