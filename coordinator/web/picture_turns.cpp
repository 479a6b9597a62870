#include "coordinator/web/picture_turns.h"

#include <algorithm>
#include <utility>

namespace hyades::coordinator {
namespace {

/// Frames in work at a time: the copy of the film of a large one is a gigabyte.
constexpr size_t kMostInWork = 2;
constexpr size_t kMostFrames = 1000;
constexpr int kMostFramesOfOne = 500;
/// In the queue, where a frame has one for each who has asked for it.
constexpr size_t kMostPlaces = 4000;

}  // namespace

bool PictureTurns::add(const AskedPicture& asked, const PictureAsker& asker) {
  const JobAndFrame id{asked.job, asked.frame};
  const std::string& owner = asker.owner.name;
  const core::MutexLock lock(mutex_);
  const auto known = wanted_.find(id);
  const bool first = known == wanted_.end();
  const bool has_place = may_wait(owner);
  if (first ? !has_place : !may_want(known->second, asked, owner)) return false;
  if (has_place) line_up(id, owner);
  wanted_[id][asked].push_back(asker);
  return true;
}

/// Whether the owner may wait for one more frame.
bool PictureTurns::may_wait(const std::string& owner) const {
  const auto own = std::count_if(queue_.begin(), queue_.end(),
                                 [&](const auto& one) { return one.second == owner; });
  return wanted_.size() < kMostFrames && queue_.size() < kMostPlaces &&
         (owner.empty() || own < kMostFramesOfOne);
}

/// The frame waits for a turn of the owner's, behind all others, if it does not yet.
void PictureTurns::line_up(JobAndFrame id, const std::string& owner) {
  const std::pair place{id, owner};
  if (std::find(queue_.begin(), queue_.end(), place) == queue_.end()) queue_.push_back(place);
}

/// Whether the owner may wait for one more of the frame: what somebody waits for already is free.
bool PictureTurns::may_want(const WantedPictures& wanted, const AskedPicture& asked,
                            const std::string& owner) {
  const auto is_own = [&](const PictureAsker& asker) { return asker.owner.name == owner; };
  int own_askers = 0;
  for (const auto& [picture, askers] : wanted) {
    own_askers += static_cast<int>(std::count_if(askers.begin(), askers.end(), is_own));
  }
  if (!owner.empty() && own_askers >= kMostAskersOfOne) return false;
  if (wanted.contains(asked)) return true;
  const auto own = std::count_if(wanted.begin(), wanted.end(), [&](const auto& one) {
    return std::any_of(one.second.begin(), one.second.end(), is_own);
  });
  return wanted.size() < kMostOfFrame && static_cast<size_t>(own) < kMostOfFrameOfOne;
}

/// Whether a frame other than `id` is in work by a turn of the owner's.
bool PictureTurns::has_turn(const std::string& owner, JobAndFrame id) const {
  return !owner.empty() && std::any_of(in_work_.begin(), in_work_.end(), [&](const auto& one) {
    return one.first != id && one.second.owner == owner;
  });
}

std::optional<PictureTurns::JobAndFrame> PictureTurns::begin_next() {
  const core::MutexLock lock(mutex_);
  const Clock::time_point now = Clock::now();
  const bool one_alone = std::any_of(in_work_.begin(), in_work_.end(),
                                     [](const auto& one) { return one.second.alone; });
  if (one_alone || in_work_.size() >= kMostInWork) return std::nullopt;
  // What was asked for while the pictures before are sent comes after them. (Clang does not see
  // that the lock is held where this is called.)
  const auto best = shares_.next(
      queue_.begin(), queue_.end(), now,
      [&](const std::pair<JobAndFrame, std::string>& one) HYADES_NO_THREAD_SAFETY_ANALYSIS {
        const bool may = !in_work_.contains(one.first) && !has_turn(one.second, one.first);
        return may ? &one.second : nullptr;
      });
  if (best == queue_.end()) return std::nullopt;
  const auto [id, owner] = *best;
  // Nothing else begins meanwhile: the memory would always be another's.
  if (alone_.contains(id) && !in_work_.empty()) return std::nullopt;
  in_work_[id] = {owner, now, now, alone_.erase(id) > 0, {}};
  return id;
}

/// What was spent for somebody: in the turn, then lately in all. Whoever has other turns meanwhile
/// would never be next in this one, if what is spent in them counted before.
PictureTurns::Spent PictureTurns::spent_for(const std::string& who, const FrameTurn& turn,
                                            Clock::time_point now) const {
  return {turn.spent.used(who, now), shares_.used(who, now)};
}

/// Of those who have asked for a picture the one for whom least was spent: it is made for him.
const std::string& PictureTurns::payer_of(const PictureAskers& askers, const FrameTurn& turn,
                                          Clock::time_point now) const {
  const auto spent = [&](const PictureAsker& asker) HYADES_NO_THREAD_SAFETY_ANALYSIS {
    return spent_for(asker.owner.name, turn, now);
  };
  return std::min_element(
             askers.begin(), askers.end(),
             [&](const PictureAsker& a, const PictureAsker& b) { return spent(a) < spent(b); })
      ->owner.name;
}

WantedPictures::iterator PictureTurns::next_of(JobAndFrame id, WantedPictures& wanted) {
  const core::MutexLock lock(mutex_);
  return next_in(in_work_.at(id), wanted, Clock::now());
}

WantedPictures::iterator PictureTurns::next_in(const FrameTurn& turn, WantedPictures& wanted,
                                               Clock::time_point now) const {
  const auto spent = [&](const auto& one) HYADES_NO_THREAD_SAFETY_ANALYSIS {
    return spent_for(payer_of(one.second, turn, now), turn, now);
  };
  return std::min_element(wanted.begin(), wanted.end(),
                          [&](const auto& a, const auto& b) { return spent(a) < spent(b); });
}

bool PictureTurns::is_alone(JobAndFrame id) {
  const core::MutexLock lock(mutex_);
  return in_work_.at(id).alone;
}

void PictureTurns::charge(JobAndFrame id, const PictureAskers& askers) {
  const core::MutexLock lock(mutex_);
  charge_locked(id, payer_of(askers, in_work_.at(id), Clock::now()));
}

void PictureTurns::charge_locked(JobAndFrame id, const std::string& whom) {
  FrameTurn& turn = in_work_.at(id);
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> taken = now - std::exchange(turn.charged, now);
  if (whom.empty()) return;
  turn.spent.use(whom, taken.count(), now);
  shares_.use(whom, taken.count(), now);
}

bool PictureTurns::gives_way(JobAndFrame id, WantedPictures& wanted) {
  const core::MutexLock lock(mutex_);
  const Clock::time_point now = Clock::now();
  const FrameTurn& turn = in_work_.at(id);
  if (now - turn.begun < longest_) return false;
  const Spent next = spent_for(payer_of(next_in(turn, wanted, now)->second, turn, now), turn, now);
  return std::any_of(queue_.begin(), queue_.end(), [&](const auto& one) HYADES_REQUIRES(mutex_) {
    const Spent other = spent_for(one.second, turn, now);
    if (one.first == id) return other < next;
    const bool may = !in_work_.contains(one.first) && !has_turn(one.second, id);
    return may && other.lately < next.lately;
  });
}

WantedPictures PictureTurns::take_wanted(JobAndFrame id) {
  const core::MutexLock lock(mutex_);
  std::erase_if(queue_, [&](const auto& one) { return one.first == id; });
  auto wanted = wanted_.extract(id);
  return wanted ? std::move(wanted.mapped()) : WantedPictures();
}

void PictureTurns::end(JobAndFrame id, const WantedPictures& left, bool no_room) {
  const core::MutexLock lock(mutex_);
  charge_locked(id, in_work_.at(id).owner);
  in_work_.erase(id);
  if (no_room) alone_.insert(id);
  put_back(id, left);
  const auto again = wanted_.find(id);
  if (again == wanted_.end()) return;
  for (const std::string& owner : owners_of(again->second)) line_up(id, owner);
}

/// What is left of a turn is wanted again. Those who wait for it had their places already: behind
/// all other frames of theirs, each time, these might never come.
void PictureTurns::put_back(JobAndFrame id, const WantedPictures& left) {
  for (const auto& [asked, askers] : left) {
    PictureAskers& all = wanted_[id][asked];
    all.insert(all.begin(), askers.begin(), askers.end());
  }
  for (const std::string& owner : owners_of(left)) {
    const std::pair place{id, owner};
    std::erase(queue_, place);
    queue_.push_front(place);
  }
}

/// All who wait for any of the pictures.
std::set<std::string> PictureTurns::owners_of(const WantedPictures& wanted) {
  std::set<std::string> owners;
  for (const auto& [asked, askers] : wanted) {
    for (const PictureAsker& asker : askers) owners.insert(asker.owner.name);
  }
  return owners;
}

}  // namespace hyades::coordinator
