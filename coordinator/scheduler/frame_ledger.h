#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "coordinator/scheduler/batch_map.h"
#include "coordinator/scheduler/failed_units.h"
#include "coordinator/scheduler/ids.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// Who renders a unit now.
struct Holder {
  WorkerId worker{};
  LeaseId lease;
};

/// A unit that is being rendered by one worker, or by several when it has been copied.
struct Assignment {
  Extent extent;
  uint64_t serial = 0;  ///< tells this assignment from later ones of the same unit
  TimePoint since;      ///< who has it first has had it since then
  std::vector<Holder> holders;
};

/// A film that counts, or will once it is durable.
struct HeldRecord {
  core::BatchRange batches;
  Digest digest{};
  WorkerId worker{};
  RecordId pending{};     ///< 0 once durable
  Witness witness{};      ///< of the worker
  bool verified = false;  ///< another witness rendered the same bits
};

/// What a worker rendered a unit to.
struct Opinion {
  WorkerId worker{};  ///< 0: not known any more; it counts for nobody
  Digest digest{};
  Witness witness{};  ///< of the worker
};

/// A held unit of which two renderings differ, or that is to be rendered twice in any case, until
/// two witnesses agree.
struct Dispute {
  Extent extent;
  std::vector<Opinion> opinions;
  bool differs = false;  ///< two renderings do, be it of one worker
};

/// The ledger of one frame. Every batch of every tile is free, leased or held, and so counts once
/// in the frame's film; held means that its film has arrived, durable or about to be.
class FrameLedger {
 public:
  /// `rounds`: see JobPlan.
  FrameLedger(const std::vector<uint32_t>& tile_order, uint32_t batches,
              std::vector<uint32_t> rounds = {});

  /// Bytes that who has which batch takes at most, of a frame of so many tiles.
  static uint64_t memory(uint64_t tiles, uint64_t batches) {
    return 2 * BatchMap::memory(tiles, batches);
  }

  uint64_t total() const { return total_; }      ///< tile-batches that are planned
  uint64_t free() const { return free_; }        ///< of these, neither leased nor held
  uint64_t durable() const { return durable_; }  ///< tile-batches whose films are durable
  /// Tile-batches that may be planned besides: a tile that is not decided gets half as many more,
  /// if it gets any.
  uint64_t likely_more() const { return undecided_ * (total_ / std::max(tile_count_, 1U)) / 2; }
  /// Whether every tile has what it needs, all films are durable and none is suspect.
  bool complete() const { return durable_ == total_ && undecided_ == 0 && settled(); }
  /// Whether all films have come, durable or not, and nobody has to render anything.
  bool all_held() const {
    return free_ == 0 && undecided_ == 0 && assignments_.empty() && disputes_.empty();
  }
  bool any_assigned() const { return !assignments_.empty(); }
  /// Workers of all assignments together: a copied unit has several.
  size_t holders() const;
  /// Who has had a unit of it since then or longer, once for each such unit.
  std::vector<WorkerId> holders_since(TimePoint time) const;

  /// Whether nobody renders any of it, or is asked about it, and all that was held is durable.
  bool idle() const {
    return assignments_.empty() && questions_ == 0 && voiding_.empty() &&
           total_ - free_ == durable_;
  }

  // Held batches.

  /// Whether some of its batches are held.
  bool any_held(const Extent& e) const { return held_.count(e.tile, e.batches) != 0; }
  /// The film of the extent, of which nothing is held, has come.
  void hold(const Extent& e, const HeldRecord& record);
  /// The record of exactly this extent, if there is one.
  const HeldRecord* find_held(const Extent& e) const;
  /// Whether what is held of exactly this extent is this record, not durable yet.
  bool waits_for(const Extent& e, RecordId record) const {
    const HeldRecord* held = find_held(e);
    return held != nullptr && held->pending == record;
  }
  /// The film that is held of exactly this extent is durable.
  void made_durable(const Extent& e);
  /// The film was lost before it was durable: its batches are free again.
  void unhold(const Extent& e);

  // Rounds (frame_rounds.cpp): a tile that has all batches planned for it is judged.

  /// How many batches of the tile are planned, from the first on.
  uint32_t planned(uint32_t tile) const {
    return rounds_.empty() ? batches_ : rounds_of_[tile].planned;
  }
  /// Whether the extent is of batches that are planned.
  bool is_planned(const Extent& e) const { return e.batches.end() <= planned(e.tile); }
  /// Whether it is not known yet if the tile needs more batches than are planned.
  bool is_undecided(uint32_t tile) const {
    return planned(tile) < batches_ && !rounds_of_[tile].enough;
  }
  /// Batches that the tile was found not to need.
  uint32_t spared(uint32_t tile) const { return is_undecided(tile) ? 0 : batches_ - planned(tile); }
  /// The extent was rendered before a restart, when the tile had been found to need it.
  void plan_for(const Extent& e);
  /// Whether the tile has all that is planned, durably, and nobody has been asked yet if that is
  /// enough.
  bool is_to_judge(uint32_t tile) const;
  /// The tiles of which that is so, in order.
  std::vector<uint32_t> to_judge() const;
  /// Somebody is asked about the tile; `serial` is of no question before.
  void ask(uint32_t tile, uint64_t serial) {
    rounds_of_[tile].asked = serial;
    ++questions_;
  }
  /// The answer to question `serial`: the tile has enough, or the next round begins. Whether it
  /// counts: not where the films that were judged are void, or about to be.
  bool judge(uint32_t tile, uint64_t serial, bool enough);
  /// Assigned units of the tile that will not be planned once its films are void.
  std::vector<Extent> assigned_beyond_first_round(uint32_t tile) const;

  // Leased batches.

  /// A unit that nobody has: a failed one that may be tried, else the next `run(tile)` batches or
  /// fewer. Nothing while many wait to be checked: those who check have to keep up.
  template <class RunLength>
  std::optional<Extent> next(const MayTry& may_try, RunLength run) {
    if (waits_for_checks()) return std::nullopt;
    if (auto retry = next_retry(may_try)) return retry;
    while (!open_.empty()) {
      const Extent front = open_.front();
      open_.pop_front();
      if (auto cut = cut_open(front, run(front.tile))) return cut;
    }
    return std::nullopt;
  }

  /// Whether next() would find something.
  bool has_work(const MayTry& may_try) const;

  /// Whether a unit has failed and waits for somebody who may try it.
  bool any_retry() const { return failed_.any_waits(); }

  /// Whether the extent can be assigned to a worker of this witness that has it already: all of it
  /// is free, or another witness has to render it too and nobody does.
  bool may_assign(const Extent& e, Witness witness) const;
  /// The holder renders the extent from now on, whose batches are free or disputed. `serial` is one
  /// that no assignment had before.
  Assignment& assign(const Extent& e, const Holder& holder, uint64_t serial);
  /// Who renders exactly this extent; null where nobody does.
  Assignment* find_assignment(const Extent& e);
  /// The assignment that `lease` holds and that covers `part`; null where there is none.
  Assignment* find_covering(const Extent& part, const LeaseId& lease);
  /// This lease no longer renders the unit; without another holder its batches are free again.
  void release(const Extent& e, const LeaseId& lease);
  /// Ends the assignment whoever holds it, and returns the holders.
  std::vector<Holder> end_assignment(const Extent& e);

  // Blame.

  /// The worker, of this witness, could not render the unit.
  void blame(const Extent& e, WorkerId worker, Witness witness) {
    failed_.blame(e, worker, witness);
  }
  /// The units that have failed.
  const FailedUnits& failed() const { return failed_; }
  /// The unit has been rendered after all: who had failed it. They are forgotten here.
  std::vector<WorkerId> take_blame(const Extent& e) { return failed_.forgive(e); }

  // Conflicts (frame_disputes.cpp).

  /// Whether no film is suspect.
  bool settled() const { return disputes_.empty() && voiding_.empty(); }
  /// How many units there are of which two renderings differ.
  size_t disputes() const;
  /// How many units wait for another witness to render them too, and nobody differs.
  size_t unconfirmed_checks() const { return disputes_.size() - disputes(); }
  /// Whether the films of some tile are about to be void.
  bool any_suspect() const { return !voiding_.empty(); }
  /// The dispute about exactly this extent; null where there is none.
  Dispute* find_dispute(const Extent& e);
  /// The witnesses that rendered exactly this extent, where others have to agree on it.
  std::vector<Witness> heard(const Extent& e) const;
  /// Two witnesses have to agree on the extent, which is held; `first` is the one that is held.
  Dispute& open_dispute(const Extent& e, const Opinion& first);
  void end_dispute(const Extent& e);
  /// Whether so many units wait for another witness that no new ones are to be had.
  bool waits_for_checks() const { return disputes_.size() >= kMostToCheck; }
  /// A disputed unit that nobody renders, for a worker whose witness was not heard about it and
  /// that may try it.
  std::optional<Extent> next_check(Witness witness, const MayTry& may_try) const;
  /// Disputed units that nobody renders.
  uint64_t waiting_checks() const;
  /// Another witness agreed on the film that is held.
  void verify(const Extent& e);
  /// Tiles that hold films of this worker on which no other agreed, in order.
  std::vector<uint32_t> unverified_tiles(WorkerId worker) const;
  /// Whose films no other worker agreed on, each once.
  std::vector<WorkerId> unconfirmed() const;
  /// The films of the tile do not count any more once that is durable; until then it takes none.
  void suspect_tile(uint32_t tile);
  bool is_suspect(uint32_t tile) const { return voiding_.contains(tile); }
  /// The suspect tiles that it has not named before, in order.
  std::vector<uint32_t> newly_suspect();
  /// The films of the tile do not count any more: all that was held of it is free again. Returns
  /// the runs of batches that were.
  std::vector<core::BatchRange> void_tile(uint32_t tile);

  /// What is wrong with the ledger, or nothing. Slow; for tests and audits.
  std::string audit() const;

 private:
  /// Units that wait for another witness, of one frame; it takes no new ones then.
  static constexpr size_t kMostToCheck = 64;

  /// How far a tile is, of a job that judges its tiles.
  struct TileRounds {
    uint32_t planned = 0;
    bool enough = false;
    uint64_t asked = 0;  ///< the question that is not answered yet; 0: none
  };

  uint32_t round_after(uint32_t batches) const;
  void extend(uint32_t tile, uint32_t planned);
  void begin_rounds_again(uint32_t tile);
  bool all_free(const Extent& e) const;
  static uint64_t key(const Extent& e) { return (uint64_t{e.tile} << 32) | e.batches.first; }
  std::optional<Extent> next_retry(const MayTry& may_try);
  std::optional<Extent> cut_open(const Extent& front, uint32_t run);
  void lease_bits(const Extent& e);
  void unlease_bits(const Extent& e);
  void free_overlapping(const Extent& e);

  bool being_checked(const Extent& e) const { return leased_.count(e.tile, e.batches) != 0; }

  uint32_t batches_;
  uint32_t tile_count_;
  std::vector<uint32_t> rounds_;
  std::vector<TileRounds> rounds_of_;  ///< by tile; empty where there are no rounds
  uint64_t total_ = 0;
  uint64_t free_ = 0;
  uint64_t undecided_ = 0;  ///< tiles of which it is not known yet if they need more
  uint64_t durable_ = 0;
  uint32_t questions_ = 0;  ///< about tiles, that are not answered
  BatchMap held_;
  BatchMap leased_;
  /// Runs that may hold free batches, in the order of leasing. Every free batch is in here or in a
  /// failed unit; what is not free any more is left out when it is taken.
  std::deque<Extent> open_;
  FailedUnits failed_;
  std::vector<Dispute> disputes_;     ///< oldest first
  std::map<uint32_t, bool> voiding_;  ///< suspect tiles, and whether newly_suspect() named them
  std::map<uint64_t, Assignment> assignments_;                     ///< by key()
  std::unordered_map<uint32_t, std::vector<HeldRecord>> records_;  ///< by tile; no order
};

}  // namespace hyades::coordinator
