#include "coordinator/web/pictures_api.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/stored_outputs.h"
#include "coordinator/controller/within_memory.h"
#include "coordinator/operations/file_transfer.h"
#include "coordinator/web/picture_encoding.h"
#include "coordinator/web/route_helpers.h"
#include "core/job/output_path.h"
#include "farm/wire.h"
#include "farm/wire_status.h"
#include "hyades/v1/web.pb.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostKeptBytes = size_t{128} << 20U;
/// A picture of a frame in work is not made more often, however many samples have come.
constexpr std::chrono::milliseconds kFreshFor{1000};
/// Frames in work at a time: the copy of the film of a large one is a gigabyte.
constexpr size_t kMostInWork = 2;
constexpr size_t kMostFrames = 1000;
constexpr int kMostFramesOfOne = 500;
/// In the queue, where a frame has one for each who has asked for it.
constexpr size_t kMostPlaces = 4000;

bool is_over(const v1::Frame& frame) { return frame.state() == v1::FRAME_STATE_DONE; }

/// How well a finished file shows a frame: 0 not at all.
int worth_of(const std::string& path, bool half) {
  if (path.ends_with(".film.exr")) return 0;
  const std::string extension = core::file_extension(path);
  if (extension == ".exr") return half ? 3 : 1;
  for (const char* known : {".png", ".jpg", ".jpeg", ".tif", ".tiff"}) {
    if (extension == known) return 2;
  }
  return 0;
}

/// What clients compare to know whether there is something newer: as of the picture, not of the
/// moment in which it is sent.
std::string stamp_of(const v1::Frame& frame) {
  return fmt::format("{}:{}:{}", frame.samples_done(), is_over(frame), frame.restarts());
}

WebReply closing() {
  return error_reply(farm::retry_later(grpc::StatusCode::UNAVAILABLE, "the coordinator ends",
                                       std::chrono::seconds(1)));
}

bool lacks_room(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
}

WebReply too_many() {
  return error_reply(farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                       "as many pictures are on their way as may be",
                                       std::chrono::seconds(1)));
}

/// The ETag of what is made of a finished file.
std::string tag_of(const StoredOutput& file) {
  return "\"" + farm::hex_from_wire(file.sha256) + "\"";
}

/// Of an open job's tag all but the frame's version: the same until the job begins anew.
std::string_view life_of(std::string_view tag) { return tag.substr(0, tag.rfind('.')); }

/// What a picture is made of.
struct Shot {
  const core::Image& image;
  const SampledMask& sampled;
  bool exact = true;  ///< linear, and not cut to 8 bits
};

/// The picture that `asked` means.
WebReply show(const PicturesApi::Asked& asked, const FrameNow& now, const Shot& shot,
              const std::string& tag) {
  const core::Image& image = shot.image;
  const auto layer = take_layer(image, asked.layer);
  if (!layer) return error_reply({grpc::StatusCode::NOT_FOUND, layer.error().message});
  SampledMask sampled = shot.sampled;
  const core::Image shown = asked.width > 0 ? shrink(*layer, asked.width, sampled) : *layer;
  WebReply reply;
  if (asked.half) {
    const HalfFacts facts{asked.layer, layers_of(image), now.frame.samples_done(),       shot.exact,
                          image.width, image.height,     asked.mask ? &sampled : nullptr};
    reply = text_reply(half_planes(shown, facts), "application/octet-stream");
  } else {
    const auto curve = core::find_tone_curve(now.tone_map);
    const auto png = display_png(shown, curve.value_or(core::ToneCurve::srgb), now.exposure);
    if (!png) return error_reply({grpc::StatusCode::INVALID_ARGUMENT, png.error().message});
    reply = text_reply(std::string(png->chars(), png->size()), "image/png");
  }
  reply.headers = {
      {"Cache-Control", "private, no-cache"}, {"ETag", tag}, {"Hyades-Stamp", stamp_of(now.frame)}};
  return reply;
}

}  // namespace

void PicturesApi::close() {
  const core::MutexLock lock(gate_->mutex);
  gate_->open = false;
}

bool PicturesApi::is_closed() const {
  const core::MutexLock lock(gate_->mutex);
  return !gate_->open;
}

void PicturesApi::add_routes(Router& router) {
  add_by_hand<v1::PictureRequest>(
      router, "GET", "/api/v1/jobs/{job}/frames/{frame}/picture",
      [this](const v1::PictureRequest& request, const WebRequest& from, const Answer& answer) {
        const Asked asked{request.job(),
                          request.frame(),
                          request.format() == v1::PICTURE_FORMAT_HALF,
                          request.mask(),
                          static_cast<int>(request.width()),
                          request.has_layer() ? request.layer() : "beauty"};
        if (!asked.half && asked.layer != "beauty") {
          answer(error_reply({grpc::StatusCode::INVALID_ARGUMENT,
                              "layer: png shows beauty; expected format=half for other layers"}));
          return;
        }
        const Asker asker{owner_of(from.caller), answer};
        const bool taken = pool_.submit(
            [this, asked, asker] {
              answer_picture(asked, asker);
              begin_some();
            },
            asker.owner.name);
        if (!taken) answer(error_reply(crowded()));
      });
}

void PicturesApi::answer_picture(const Asked& asked, const Asker& asker) {
  if (is_closed()) return asker.answer(closing());
  FrameNow now;
  if (const grpc::Status known = controller_.queries().frame_now(asked.job, asked.frame, now);
      !known.ok()) {
    return asker.answer(error_reply(known));
  }
  const bool over = is_over(now.frame);
  std::string tag = now.tag;
  if (over) {
    const auto file = best_file(asked);
    if (!file) return asker.answer(error_reply(farm::unavailable(file.error())));
    tag = *file ? tag_of(**file) : std::string();
  }
  if (const auto made = find(asked, tag, over)) return asker.answer(*made);
  if (!has_room(asker.owner)) return asker.answer(too_many());
  if (!enqueue(asked, asker)) asker.answer(error_reply(crowded()));
}

/// The finished file that shows best what is asked for; nothing where none shows it.
core::Result<std::optional<StoredOutput>> PicturesApi::best_file(const Asked& asked) {
  const auto outputs = controller_.store().outputs_of(asked.job, asked.frame);
  if (!outputs) return outputs.error();
  std::optional<StoredOutput> best;
  for (const StoredOutput& output : *outputs) {
    const int worth = worth_of(output.path, asked.half);
    if (worth > (best ? worth_of(best->path, asked.half) : 0)) best = output;
  }
  return best;
}

/// A finished file that pictures are made of, and the room that it takes.
struct PicturesApi::OpenFile {
  std::string path;
  std::shared_ptr<const void> room;
  core::Image image;
};

grpc::Status PicturesApi::of_file(const Asked& asked, const farm::ByteBudget::Owner& owner,
                                  const FrameNow& now, std::optional<OpenFile>& open,
                                  WebReply& reply) {
  const auto best = best_file(asked);
  if (!best) return farm::unavailable(best.error());
  if (!*best) {
    return {grpc::StatusCode::NOT_FOUND,
            fmt::format("no picture of frame {} is kept", asked.frame)};
  }
  const StoredOutput& file = **best;
  const std::string tag = tag_of(file);
  if (auto made = find(asked, tag, true)) {
    reply = std::move(*made);
    return grpc::Status::OK;
  }
  if (!open || open->path != file.path) {
    open.reset();
    OpenFile fresh;
    fresh.path = file.path;
    const grpc::Status read =
        controller_.queries().picture(asked.job, file, fresh.image, fresh.room);
    if (read.error_code() == grpc::StatusCode::DATA_LOSS) {
      return damaged_output(file.path);
    }
    if (!read.ok()) return read;
    open = std::move(fresh);
  }
  FrameNow plain = now;
  plain.tone_map = "srgb";  // a finished picture has its own
  plain.exposure = 0;
  const bool exact = core::file_extension(file.path) == ".exr";
  reply = show(asked, plain, {open->image, {}, exact}, tag);
  count(reply, owner);
  keep(asked, tag, true, reply, owner);
  return grpc::Status::OK;
}

/// Has the picture made when its frame has a turn, which comes by whoever asks for the frame:
/// others may have asked first, and for very many. False where too many frames wait, or too many
/// pictures of this one.
bool PicturesApi::enqueue(const Asked& asked, const Asker& asker) {
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
bool PicturesApi::may_wait(const std::string& owner) const {
  const auto own = std::count_if(queue_.begin(), queue_.end(),
                                 [&](const auto& one) { return one.second == owner; });
  return wanted_.size() < kMostFrames && queue_.size() < kMostPlaces &&
         (owner.empty() || own < kMostFramesOfOne);
}

/// The frame waits for a turn of the owner's, behind all others, if it does not yet.
void PicturesApi::line_up(JobAndFrame id, const std::string& owner) {
  const std::pair place{id, owner};
  if (std::find(queue_.begin(), queue_.end(), place) == queue_.end()) queue_.push_back(place);
}

/// Whether the owner may wait for one more of the frame: what somebody waits for already is free.
bool PicturesApi::may_want(const Wanted& wanted, const Asked& asked, const std::string& owner) {
  if (wanted.contains(asked)) return true;
  const auto own = std::count_if(wanted.begin(), wanted.end(), [&](const auto& one) {
    return std::any_of(one.second.begin(), one.second.end(),
                       [&](const Asker& asker) { return asker.owner.name == owner; });
  });
  return wanted.size() < kMostOfFrame && static_cast<size_t>(own) < kMostOfFrameOfOne;
}

void PicturesApi::begin_some() {
  while (const auto id = begin_next()) take(*id);
}

/// Whether a frame other than `id` is in work by a turn of the owner's.
bool PicturesApi::has_turn(const std::string& owner, JobAndFrame id) const {
  return !owner.empty() && std::any_of(in_work_.begin(), in_work_.end(), [&](const auto& one) {
    return one.first != id && one.second.owner == owner;
  });
}

/// The frame whose turn it is; none: as many are in work as may be, or their callers'.
std::optional<PicturesApi::JobAndFrame> PicturesApi::begin_next() {
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

void PicturesApi::take(JobAndFrame id) {
  // As of before the film, so that the picture never claims more than it shows.
  FrameNow now;
  if (is_closed()) return end(id, closing());
  const grpc::Status status = controller_.queries().frame_now(id.first, id.second, now);
  if (!status.ok()) {
    end(id, error_reply(status));
  } else if (is_over(now.frame)) {
    const bool taken = pool_.submit([this, id, now] { take_files(id, now); });
    if (!taken) end(id, error_reply(crowded()));
  } else {
    take_film(id, now);
  }
}

void PicturesApi::take_film(JobAndFrame id, const FrameNow& now) {
  controller_.steering().note_watched(id.first, id.second);
  grpc::Status status = controller_.queries().film_alone(
      id.first, id.second,
      [this, gate = gate_, id, now](const grpc::Status& found, const core::FilmInfo&,
                                    std::shared_ptr<const core::Film> film) {
        const core::MutexLock lock(gate->mutex);
        if (!gate->open) return;
        const bool taken = pool_.submit([this, id, now, found, film = std::move(film)]() mutable {
          make_all(id, now, found, std::move(film));
        });
        if (!taken) end(id, error_reply(crowded()));
      });
  if (status.ok()) return;
  if (lacks_room(status) && !turn_of(id).alone) return leave(id, {}, true);
  // Done meanwhile: those who ask again get the finished picture.
  if (status.error_code() == grpc::StatusCode::FAILED_PRECONDITION) {
    status = farm::retry_later(grpc::StatusCode::UNAVAILABLE, "the frame is being finished",
                               std::chrono::milliseconds(500));
  }
  end(id, error_reply(status));
}

void PicturesApi::take_files(JobAndFrame id, const FrameNow& now) {
  make_wanted(id, [this, now, open = std::optional<OpenFile>()](
                      const Asked& asked, const farm::ByteBudget::Owner& owner,
                      WebReply& reply) mutable { return of_file(asked, owner, now, open, reply); });
}

void PicturesApi::make_all(JobAndFrame id, const FrameNow& now, const grpc::Status& found,
                           std::shared_ptr<const core::Film> film) {
  if (lacks_room(found) && !turn_of(id).alone) return leave(id, {}, true);
  if (!found.ok()) return end(id, error_reply(found));
  core::Image image;
  SampledMask sampled;
  const grpc::Status made = within_memory([&] {
    image = film->normalised();
    sampled = sampled_pixels(*film);
    return grpc::Status::OK;
  });
  make_wanted(id, [this, now, made, room = std::move(film), image = std::move(image),
                   sampled = std::move(sampled)](
                      const Asked& asked, const farm::ByteBudget::Owner& owner, WebReply& reply) {
    if (!made.ok()) return made;
    reply = show(asked, now, {image, sampled}, now.tag);
    count(reply, owner);
    keep(asked, now.tag, false, reply, owner);
    return grpc::Status::OK;
  });
}

/// Makes what is wanted of the frame by now, until its turn is over: those who wait share it, by
/// whomever it has come. What finds no memory beside another frame is made in a turn alone.
void PicturesApi::make_wanted(JobAndFrame id, Make make) {
  const Turn turn = turn_of(id);
  Wanted wanted = take_wanted(id);
  bool no_room = false;
  for (bool over = wanted.empty(); !over;) {
    const auto next = next_of(id, wanted);
    const auto& [asked, askers] = *next;
    WebReply reply;
    no_room = !make_one(asked, askers, make, reply) && !turn.alone;
    if (no_room) break;
    charge(id, askers);
    for (const Asker& asker : askers) asker.answer(reply);
    wanted.erase(next);
    over = wanted.empty() || gives_way(id, wanted);
  }
  make = nullptr;  // who is next needs its room
  leave(id, wanted, no_room);
}

/// Makes `reply`, which those who have asked are told. False where there is no memory for it: of
/// all that may be wrong nothing else is better in a turn alone.
bool PicturesApi::make_one(const Asked& asked, const Askers& askers, const Make& make,
                           WebReply& reply) {
  const auto who = std::find_if(askers.begin(), askers.end(),
                                [&](const Asker& asker) { return has_room(asker.owner); });
  if (is_closed() || who == askers.end()) {
    reply = is_closed() ? closing() : too_many();
    return true;
  }
  const grpc::Status made = within_memory([&] { return make(asked, who->owner, reply); });
  if (!made.ok()) reply = error_reply(made);
  return !lacks_room(made);
}

/// What was spent for somebody: in the turn, then lately in all. Whoever has other turns meanwhile
/// would never be next in this one, if what is spent in them counted before.
PicturesApi::Spent PicturesApi::spent_for(const std::string& who, const Turn& turn,
                                          Clock::time_point now) const {
  return {turn.spent.used(who, now), shares_.used(who, now)};
}

/// Of those who have asked for a picture the one for whom least was spent: it is made for him.
const std::string& PicturesApi::payer_of(const Askers& askers, const Turn& turn,
                                         Clock::time_point now) const {
  const auto spent = [&](const Asker& asker) HYADES_NO_THREAD_SAFETY_ANALYSIS {
    return spent_for(asker.owner.name, turn, now);
  };
  return std::min_element(askers.begin(), askers.end(),
                          [&](const Asker& a, const Asker& b) { return spent(a) < spent(b); })
      ->owner.name;
}

/// What is made next in the turn of what is wanted: for whom least was spent.
PicturesApi::Wanted::iterator PicturesApi::next_of(JobAndFrame id, Wanted& wanted) {
  const core::MutexLock lock(mutex_);
  return next_in(in_work_.at(id), wanted, Clock::now());
}

PicturesApi::Wanted::iterator PicturesApi::next_in(const Turn& turn, Wanted& wanted,
                                                   Clock::time_point now) const {
  const auto spent = [&](const auto& one) HYADES_NO_THREAD_SAFETY_ANALYSIS {
    return spent_for(payer_of(one.second, turn, now), turn, now);
  };
  return std::min_element(wanted.begin(), wanted.end(),
                          [&](const auto& a, const auto& b) { return spent(a) < spent(b); });
}

PicturesApi::Turn PicturesApi::turn_of(JobAndFrame id) {
  const core::MutexLock lock(mutex_);
  return in_work_.at(id);
}

/// What the turn has taken since the last charge was for a picture, for one of those who have asked
/// for it.
void PicturesApi::charge(JobAndFrame id, const Askers& askers) {
  const core::MutexLock lock(mutex_);
  charge_locked(id, payer_of(askers, in_work_.at(id), Clock::now()));
}

void PicturesApi::charge_locked(JobAndFrame id, const std::string& whom) {
  Turn& turn = in_work_.at(id);
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> taken = now - std::exchange(turn.charged, now);
  if (whom.empty()) return;
  turn.spent.use(whom, taken.count(), now);
  shares_.use(whom, taken.count(), now);
}

/// Whether the frame's turn ends before what is next of `wanted`: it has lasted for long, and
/// somebody waits for whom less time was spent: in this turn, where he waits for the same frame,
/// lately in all, where for one that might begin if this turn was over.
bool PicturesApi::gives_way(JobAndFrame id, Wanted& wanted) {
  const core::MutexLock lock(mutex_);
  const Clock::time_point now = Clock::now();
  const Turn& turn = in_work_.at(id);
  if (now - turn.begun < longest_turn_) return false;
  const Spent next = spent_for(payer_of(next_in(turn, wanted, now)->second, turn, now), turn, now);
  return std::any_of(queue_.begin(), queue_.end(), [&](const auto& one) HYADES_REQUIRES(mutex_) {
    const Spent other = spent_for(one.second, turn, now);
    if (one.first == id) return other < next;
    const bool may = !in_work_.contains(one.first) && !has_turn(one.second, id);
    return may && other.lately < next.lately;
  });
}

/// Whether a picture may be made for the owner: how large it becomes is not known before.
bool PicturesApi::has_room(const farm::ByteBudget::Owner& owner) {
  if (held_->has_room(owner, 1)) return true;
  // What is kept in case somebody asks for it gives way to what somebody asks for: what counts for
  // him, or, where others have taken the room, all.
  const bool his_alone = held_->has_room({}, 1);
  {
    const core::MutexLock lock(mutex_);
    for (auto next = kept_.begin(); next != kept_.end();) {
      const auto one = next++;
      if (!his_alone || one->second.owner == owner.name) forget(one);
    }
  }
  return held_->has_room(owner, 1);
}

/// Counts the picture for as long as anybody holds it: a connection that does not read, say.
void PicturesApi::count(WebReply& reply, const farm::ByteBudget::Owner& owner) const {
  if (reply.status != 200) return;
  struct Counted {
    Counted(std::shared_ptr<farm::ByteBudget> of, const farm::ByteBudget::Owner& owner,
            std::shared_ptr<const std::string> bytes)
        : budget(std::move(of)), share(*budget, owner), text(std::move(bytes)) {
      share.hold(text->size());
    }
    std::shared_ptr<farm::ByteBudget> budget;
    farm::ByteBudget::Share share;
    std::shared_ptr<const std::string> text;
  };
  const auto counted = std::make_shared<Counted>(held_, owner, std::move(reply.text));
  reply.text = std::shared_ptr<const std::string>(counted, counted->text.get());
}

/// What is wanted of the frame by now; what is asked for from now on comes after it.
PicturesApi::Wanted PicturesApi::take_wanted(JobAndFrame id) {
  const core::MutexLock lock(mutex_);
  std::erase_if(queue_, [&](const auto& one) { return one.first == id; });
  auto wanted = wanted_.extract(id);
  return wanted ? std::move(wanted.mapped()) : Wanted();
}

/// Everybody who waits for pictures of the frame is told this.
void PicturesApi::end(JobAndFrame id, const WebReply& reply) {
  for (const auto& [asked, askers] : take_wanted(id)) {
    for (const Asker& asker : askers) asker.answer(reply);
  }
  leave(id, {}, false);
}

/// The frame's turn is over, and the next begins. For what is `left` of it, or was not taken, there
/// is another one: alone where there was `no_room`.
void PicturesApi::leave(JobAndFrame id, const Wanted& left, bool no_room) {
  {
    const core::MutexLock lock(mutex_);
    charge_locked(id, in_work_.at(id).owner);
    in_work_.erase(id);
    if (no_room) alone_.insert(id);
    put_back(id, left);
    if (const auto again = wanted_.find(id); again != wanted_.end()) {
      for (const std::string& owner : owners_of(again->second)) line_up(id, owner);
    }
  }
  // Where so much waits that this may not, whatever is asked for next begins with what is next.
  (void)pool_.submit([this] { begin_some(); });
}

/// What is left of a turn is wanted again. Those who wait for it had their places already: behind
/// all other frames of theirs, each time, these might never come.
void PicturesApi::put_back(JobAndFrame id, const Wanted& left) {
  for (const auto& [asked, askers] : left) {
    Askers& all = wanted_[id][asked];
    all.insert(all.begin(), askers.begin(), askers.end());
  }
  for (const std::string& owner : owners_of(left)) {
    const std::pair place{id, owner};
    std::erase(queue_, place);
    queue_.push_front(place);
  }
}

/// All who wait for any of the pictures.
std::set<std::string> PicturesApi::owners_of(const Wanted& wanted) {
  std::set<std::string> owners;
  for (const auto& [asked, askers] : wanted) {
    for (const Asker& asker : askers) owners.insert(asker.owner.name);
  }
  return owners;
}

std::optional<WebReply> PicturesApi::find(const Asked& asked, const std::string& tag, bool over) {
  const core::MutexLock lock(mutex_);
  const auto found = index_.find(asked);
  if (found == index_.end()) return std::nullopt;
  const Made& made = found->second->second;
  // A job that begins anew has nothing of before.
  const bool of_now = !over && !made.over && life_of(made.tag) == life_of(tag);
  const bool fresh = made.tag == tag || (of_now && Clock::now() - made.at < kFreshFor);
  if (!fresh) return std::nullopt;
  kept_.splice(kept_.begin(), kept_, found->second);
  return made.reply;
}

void PicturesApi::keep(const Asked& asked, const std::string& tag, bool over, const WebReply& reply,
                       const farm::ByteBudget::Owner& owner) {
  if (reply.status != 200) return;
  const core::MutexLock lock(mutex_);
  if (const auto old = index_.find(asked); old != index_.end()) forget(old->second);
  kept_.emplace_front(asked, Made{tag, over, Clock::now(), reply, owner.name});
  index_[asked] = kept_.begin();
  kept_bytes_ += reply.text->size();
  while (kept_bytes_ > kMostKeptBytes && kept_.size() > 1) forget(std::prev(kept_.end()));
}

void PicturesApi::forget(Kept::iterator one) {
  kept_bytes_ -= one->second.reply.text->size();
  index_.erase(one->first);
  kept_.erase(one);
}

}  // namespace hyades::coordinator
