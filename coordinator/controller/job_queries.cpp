#include "coordinator/controller/job_queries.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/not_found.h"
#include "coordinator/controller/stored_outputs.h"
#include "coordinator/controller/within_memory.h"
#include "core/base/text.h"
#include "core/film/film_exr.h"
#include "core/image/read_image.h"
#include "core/job/film_file.h"
#include "core/job/output_path.h"
#include "core/job/video.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kMostListed = 1000;        ///< jobs
constexpr uint32_t kMostFramesAtOnce = 2000;  ///< that are read from the store
constexpr uint32_t kMostSteps = 2000;         ///< of a timeline, in an answer

v1::TimelineStep to_wire(const TimedStep& step) {
  v1::TimelineStep wire;
  wire.set_number(step.number);
  wire.set_kind(step.kind);
  wire.set_worker(step.worker);
  wire.set_thread(step.thread);
  *wire.mutable_unit() = farm::to_wire(step.unit);
  wire.set_begun_us(step.begun_us);
  wire.set_ended_us(step.ended_us);
  return wire;
}

grpc::Status nothing_yet() {
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE, "nothing of the frame is there yet",
                           std::chrono::seconds(1));
}

/// Whether the frame has a film, or will have one, which nobody has finished.
bool grows(const ActiveJob& active, int32_t frame) HYADES_REQUIRES(state_lock) {
  const auto noted = active.frames.find(frame);
  return !active.ending && noted != active.frames.end() &&
         noted->second.state != v1::FRAME_STATE_DONE;
}

v1::Frame describe_over(const StoredFrame& frame, const StoredJob& job) {
  v1::Frame wire;
  wire.set_frame(frame.frame);
  wire.set_state(frame.done ? v1::FRAME_STATE_DONE : v1::FRAME_STATE_FAILED);
  wire.set_samples(job.frames > 0 ? job.samples / job.frames : 0);
  wire.set_samples_done(frame.done ? wire.samples() : 0);
  wire.set_reason(frame.reason);
  wire.set_worker_class(frame.worker_class);
  wire.set_restarts(frame.restarts);
  wire.set_doubtful(frame.suspect);
  wire.set_black(frame.black);
  return wire;
}

/// Frames as far as they fit into one message.
class FramePage {
 public:
  FramePage(google::protobuf::RepeatedPtrField<v1::Frame>& frames, size_t most_bytes)
      : frames_(frames), most_bytes_(most_bytes) {}
  bool full() const { return bytes_ > most_bytes_; }
  void add(const v1::Frame& frame) {
    bytes_ += frame.ByteSizeLong() + kEnvelope;
    *frames_.Add() = frame;
  }

 private:
  google::protobuf::RepeatedPtrField<v1::Frame>& frames_;
  static constexpr size_t kEnvelope = 3;  // tag and length
  const size_t most_bytes_;
  size_t bytes_ = 0;
};

/// Frames that are looked at before others get the state lock.
constexpr int kMostLookedAt = 10'000;

bool is_wanted(v1::FrameState state, v1::FrameState only) {
  return only == v1::FRAME_STATE_UNSPECIFIED || state == only;
}

uint32_t most_listed(const v1::ListJobsRequest& request) {
  return request.limit() == 0 ? kMostListed : std::min(request.limit(), kMostListed);
}

std::map<int32_t, FrameNote>::const_iterator above(const std::map<int32_t, FrameNote>& frames,
                                                   std::optional<int32_t> after) {
  return after ? frames.upper_bound(*after) : frames.begin();
}

/// The film, and the room that it takes, for as long as somebody has it.
std::shared_ptr<const core::Film> kept_with(std::shared_ptr<const void> room, core::Film film) {
  struct Kept {
    std::shared_ptr<const void> room;
    core::Film film;
  };
  const auto kept = std::make_shared<const Kept>(Kept{std::move(room), std::move(film)});
  return {kept, &kept->film};
}

grpc::Status no_room_for_copy() {
  return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                           "copies of films take as much memory as they may",
                           std::chrono::seconds(2));
}

grpc::Status too_large(uint64_t bytes, const FilmCopies& copies) {
  return {grpc::StatusCode::FAILED_PRECONDITION,
          fmt::format("the film is too large to be shown: that takes {}, and may take {} (a "
                      "quarter of --film-memory)",
                      core::format_bytes(bytes), core::format_bytes(copies.most()))};
}

/// Why so many bytes could not be held.
grpc::Status no_room(uint64_t bytes, const FilmCopies& copies) {
  return bytes > copies.most() ? too_large(bytes, copies) : no_room_for_copy();
}

/// What a film of so many bytes takes with the picture that is made of it.
uint64_t with_picture(uint64_t film_bytes) { return film_bytes / 2 * 3; }

/// A copy of the frame's film, on the film store's thread. `most`: bytes of one that is set aside.
grpc::Status copy_of(const FilmStore& store, int32_t frame, uint64_t most, FilmCopies& copies,
                     std::shared_ptr<const core::Film>& copy) {
  auto film = store.film(frame);
  const bool aside = store.is_aside(frame);
  if (!film && !aside) return nothing_yet();
  const uint64_t bytes = with_picture(film ? film->memory() : most);
  const auto room = copies.hold(bytes);
  if (!room) return no_room(bytes, copies);
  if (aside) {
    if (auto kept = store.read_aside(frame)) film = std::move(*kept);
  }
  if (!film) return nothing_yet();
  copy = kept_with(room, core::Film(*film));
  return grpc::Status::OK;
}

}  // namespace

v1::Job JobQueries::describe(const ActiveJob& active) const {
  v1::Job job = active.describe(dispatcher_.scheduler().leased_units(active.id));
  // Until its end is stored, it has not ended for anybody.
  if (active.ending) job.set_state(v1::JOB_STATE_RUNNING);
  // Of a full disk a job knows nothing, and no worker that comes helps.
  const bool may_begin = job.reason().empty() || job.reason() == active.obstacle;
  if (may_begin && !disk_.reason().empty()) job.set_reason(disk_.reason());
  count_cost(job);
  return job;
}

v1::Job JobQueries::describe(const StoredJob& stored) const {
  v1::Job job = coordinator::describe(stored);
  count_cost(job);
  return job;
}

void JobQueries::count_cost(v1::Job& job) const {
  job.set_cost(job.core_seconds() / 3600 * context_.options.price.per_core_hour);
}

bool JobQueries::list_open(const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
  if (request.ended()) return false;
  const int limit = static_cast<int>(most_listed(request));
  const StateLock lock(context_.mutex);
  const bool all = request.before() == 0;
  auto active = all ? jobs_.all().end() : jobs_.all().lower_bound(JobId{request.before()});
  auto waiting = all ? jobs_.waiting().end() : jobs_.waiting().lower_bound(request.before());
  while (active != jobs_.all().begin() || waiting != jobs_.waiting().begin()) {
    // The newest of both.
    const bool recovered = waiting == jobs_.waiting().begin() ||
                           (active != jobs_.all().begin() &&
                            std::prev(active)->second->stored.id > std::prev(waiting)->first);
    const StoredJob& stored = recovered ? (--active)->second->stored : (--waiting)->second;
    if (!request.owner().empty() && stored.owner != request.owner()) continue;
    // One that waits is open already, for an instant, while it is recovered.
    if (!recovered && jobs_.all().contains(JobId{stored.id})) continue;
    *response.add_jobs() = recovered ? describe(*active->second) : describe(stored);
    if (response.jobs_size() < limit) continue;
    response.set_next_before(stored.id);
    break;
  }
  return true;
}

grpc::Status JobQueries::list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
  const uint32_t limit = most_listed(request);
  const auto jobs = context_.store->list(request.ended(), request.owner(), request.before(), limit);
  if (!jobs) return farm::unavailable(jobs.error());
  const StateLock lock(context_.mutex);
  for (const StoredJob& job : *jobs) {
    const ActiveJob* active = jobs_.find(job.id);
    *response.add_jobs() = active != nullptr ? describe(*active) : describe(job);
  }
  if (jobs->size() == limit) response.set_next_before(jobs->back().id);
  return grpc::Status::OK;
}

bool JobQueries::get_open(uint64_t id, std::optional<int32_t> after, v1::GetJobResponse& response,
                          v1::FrameState only, size_t most_bytes) {
  FramePage page(*response.mutable_frames(), most_bytes);
  // A job may have a million frames, and few of them in that state: others get the lock in between.
  for (bool at_end = false; !at_end;) {
    const StateLock lock(context_.mutex);
    const ActiveJob* active = jobs_.find(id);
    if (active == nullptr) {
      response.clear_frames();
      return false;
    }
    *response.mutable_job() = describe(*active);
    auto it = above(active->frames, after);
    for (int looked = 0; looked < kMostLookedAt && it != active->frames.end(); ++looked, ++it) {
      after = it->first;
      if (!is_wanted(it->second.state, only)) continue;
      response.set_more(page.full());
      if (page.full()) return true;
      page.add(active->describe_frame(it->first, it->second));
    }
    at_end = it == active->frames.end();
  }
  return true;
}

grpc::Status JobQueries::get(uint64_t id, std::optional<int32_t> after,
                             v1::GetJobResponse& response, v1::FrameState only, size_t most_bytes) {
  if (get_open(id, after, response, only, most_bytes)) return grpc::Status::OK;
  FramePage page(*response.mutable_frames(), most_bytes);
  auto stored = context_.store->summary(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  {
    const StateLock lock(context_.mutex);
    const auto waiting = jobs_.waiting().find(id);
    if (waiting != jobs_.waiting().end() && !has_ended((*stored)->state))
      (*stored)->reason = waiting->second.reason;
  }
  *response.mutable_job() = describe(**stored);
  for (;;) {
    const auto frames = context_.store->frames(id, after, kMostFramesAtOnce);
    if (!frames) return farm::unavailable(frames.error());
    for (const StoredFrame& row : *frames) {
      const v1::Frame frame = describe_over(row, **stored);
      after = row.frame;
      if (!is_wanted(frame.state(), only)) continue;
      if (page.full()) {
        response.set_more(true);
        return grpc::Status::OK;
      }
      page.add(frame);
    }
    const bool last = frames->size() < kMostFramesAtOnce;
    // Of some states there may be few: then it is looked for more of them.
    response.set_more(!last);
    if (last || only == v1::FRAME_STATE_UNSPECIFIED) return grpc::Status::OK;
  }
}

bool JobQueries::changes_of_open(uint64_t id, ChangeCursor& cursor, v1::WatchEvent& event) {
  const StateLock lock(context_.mutex);
  const ActiveJob* active = jobs_.find(id);
  if (active == nullptr) return false;
  *event.mutable_job() = describe(*active);
  if (cursor.life != active->life) {
    ChangeCursor begin;
    begin.life = active->life;
    begin.page_bytes = cursor.page_bytes;
    cursor = begin;
  }
  FramePage page(*event.mutable_changed(), cursor.page_bytes);
  if (cursor.version != 0) {
    auto it = active->changed.upper_bound(cursor.version);
    for (; it != active->changed.end() && !page.full(); ++it) {
      page.add(active->describe_frame(it->second, active->frames.at(it->second)));
      cursor.version = it->first;
    }
    event.set_more(it != active->changed.end());
    // What has changed of the job alone, such as what it waits for, is told with these.
    if (!event.more()) cursor.version = active->version;
    return true;
  }
  if (!cursor.after) cursor.first_version = active->version;
  auto it = above(active->frames, cursor.after);
  for (; it != active->frames.end() && !page.full(); ++it) {
    page.add(active->describe_frame(it->first, it->second));
    cursor.after = it->first;
  }
  event.set_more(it != active->frames.end());
  if (event.more()) return true;
  cursor.version = cursor.first_version;
  cursor.after.reset();
  return true;
}

grpc::Status JobQueries::changes(uint64_t id, ChangeCursor& cursor, v1::WatchEvent& event,
                                 bool& ended) {
  ended = false;
  if (changes_of_open(id, cursor, event)) return grpc::Status::OK;
  if (!std::exchange(cursor.over, true)) cursor.after.reset();
  v1::GetJobResponse over;
  const grpc::Status status =
      get(id, cursor.after, over, v1::FRAME_STATE_UNSPECIFIED, cursor.page_bytes);
  if (!status.ok()) return status;
  if (over.frames_size() > 0) cursor.after = over.frames().rbegin()->frame();
  event.set_more(over.more());
  event.mutable_job()->Swap(over.mutable_job());
  event.mutable_changed()->Swap(over.mutable_frames());
  ended = true;
  return grpc::Status::OK;
}

grpc::Status JobQueries::frame_now(uint64_t id, int32_t frame, FrameNow& now) {
  {
    const StateLock lock(context_.mutex);
    if (const ActiveJob* active = jobs_.find(id)) {
      const auto noted = active->frames.find(frame);
      if (noted == active->frames.end()) return no_frame(id, frame);
      now.frame = active->describe_frame(frame, noted->second);
      now.tag = fmt::format("\"{}.{}.{}.{}\"", context_.started_ms, context_.incarnation,
                            active->life, noted->second.version);
      now.tone_map = active->tone_map;
      now.exposure = active->exposure;
      return grpc::Status::OK;
    }
  }
  const auto stored = context_.store->summary(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  const auto before = frame == INT32_MIN ? std::nullopt : std::optional(frame - 1);
  const auto frames = context_.store->frames(id, before, 1);
  if (!frames) return farm::unavailable(frames.error());
  if (frames->empty() || frames->front().frame != frame) return no_frame(id, frame);
  now.frame = describe_over(frames->front(), **stored);
  return grpc::Status::OK;
}

grpc::Status JobQueries::give_kept_film(uint64_t id, int32_t frame, const FilmTaker& then) {
  core::FilmInfo info;
  std::shared_ptr<const core::Film> film;
  const grpc::Status read = within_memory([&] { return kept_film(id, frame, info, film); });
  if (read.ok()) then(read, info, std::move(film));
  return read;
}

/// The film of a frame that is done.
grpc::Status JobQueries::kept_film(uint64_t id, int32_t frame, core::FilmInfo& info,
                                   std::shared_ptr<const core::Film>& film) {
  const auto stored = context_.store->summary(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  const auto outputs = context_.store->outputs_of(id, frame);
  if (!outputs) return farm::unavailable(outputs.error());
  for (const StoredOutput& output : *outputs) {
    if (!output.path.ends_with(".film.exr")) continue;
    FilmCopies& copies = context_.film_copies;
    const auto file_room = copies.hold(output.size);
    if (!file_room) return no_room(output.size, copies);
    const auto bytes = read_output(context_.output_folder(id), output);
    if (!bytes) return {grpc::StatusCode::DATA_LOSS, bytes.error().message};
    const auto memory = core::film_exr_memory(*bytes, output.path);
    if (!memory) return {grpc::StatusCode::DATA_LOSS, memory.error().message};
    const auto room = copies.hold(with_picture(*memory));
    if (!room) return no_room(with_picture(*memory), copies);
    auto file = core::read_film_exr(*bytes, output.path);
    if (!file) return {grpc::StatusCode::DATA_LOSS, file.error().message};
    info = std::move(file->info);
    film = kept_with(room, std::move(file->film));
    return grpc::Status::OK;
  }
  return {grpc::StatusCode::FAILED_PRECONDITION,
          fmt::format("there is no film of frame {} any more; 'keep_films: true' in the job keeps "
                      "those of finished frames",
                      frame)};
}

grpc::Status JobQueries::picture(uint64_t id, const StoredOutput& output, core::Image& image,
                                 std::shared_ptr<const void>& room) {
  constexpr uint64_t kTimes = 40;  // what files hold mostly, but one that is black is a thousandth
  constexpr uint64_t kLeast = uint64_t{16} << 20U;
  constexpr uint64_t kOfPixel = 32;  // of four channels, and once more of what is made of them
  FilmCopies& copies = context_.film_copies;
  if (output.size > copies.most()) return no_room(output.size, copies);
  std::optional<core::Bytes> bytes;
  // The file and what it holds. Few take more than a quarter of all room, whatever they are packed
  // to; what turns out to be larger is tried again with more, at last with all there is.
  const uint64_t likely = std::max(output.size + kTimes * output.size, kLeast);
  for (uint64_t held = std::min(likely, copies.most() / 4);;
       held = std::min(2 * held, copies.most())) {
    if (held <= output.size && held < copies.most()) continue;
    room.reset();
    room = copies.hold(held);
    if (!room) return no_room_for_copy();
    if (!bytes) {
      auto read = read_output(context_.output_folder(id), output);
      if (!read) return {grpc::StatusCode::DATA_LOSS, read.error().message};
      bytes = std::move(*read);
    }
    core::ImageLimits limits;
    if (held < copies.most()) {
      limits.max_pixels = std::min<uint64_t>(limits.max_pixels, (held - output.size) / kOfPixel);
    }
    auto read = core::read_image(*bytes, output.path, core::ColorSpace::automatic, limits);
    if (read) {
      image = std::move(*read);
      return grpc::Status::OK;
    }
    if (held == copies.most()) return {grpc::StatusCode::DATA_LOSS, read.error().message};
  }
}

grpc::Status JobQueries::film(uint64_t id, int32_t frame, const std::string& asker,
                              FilmTaker then) {
  std::string spec;
  {
    const StateLock lock(context_.mutex);
    const ActiveJob* active = jobs_.find(id);
    if (active != nullptr && grows(*active, frame)) {
      spec = active->stored.spec;
    }
  }
  if (spec.empty()) return copy_film(id, frame, std::nullopt, std::move(then));
  auto document = context_.documents.read_stored(spec, kReadingPatience, asker);
  if (!document) return others_are_read();
  if (!*document) return {grpc::StatusCode::DATA_LOSS, document->error().message};
  core::FilmInfo info = core::film_info((**document)->job, frame, (**document)->assets);
  document.reset();  // others may be read
  return copy_film(id, frame, std::move(info), std::move(then));
}

grpc::Status JobQueries::film_alone(uint64_t id, int32_t frame, FilmTaker then) {
  return copy_film(id, frame, core::FilmInfo(), std::move(then));
}

/// `info`: of a film that grows, but for its class.
grpc::Status JobQueries::copy_film(uint64_t id, int32_t frame, std::optional<core::FilmInfo> info,
                                   FilmTaker then) {
  StateLock lock(context_.mutex);
  ActiveJob* active = jobs_.find(id);
  if (active == nullptr || active->ending) {
    lock.unlock();
    return give_kept_film(id, frame, then);
  }
  const auto noted = active->frames.find(frame);
  if (noted == active->frames.end()) {
    return no_frame(id, frame);
  }
  if (noted->second.state == v1::FRAME_STATE_DONE) {
    lock.unlock();
    return give_kept_film(id, frame, then);
  }
  // Without `info` it has begun to grow just now.
  if (!active->film_store || !info) return nothing_yet();
  info->worker_class = noted->second.worker_class;
  // The film store's thread copies, as only it may look at films while they grow.
  active->film_store->call([film_store = active->film_store.get(), &copies = context_.film_copies,
                            frame, most = active->film_bytes, info = std::move(*info),
                            then = std::move(then)] {
    std::shared_ptr<const core::Film> film;
    const grpc::Status copied =
        within_memory([&] { return copy_of(*film_store, frame, most, copies, film); });
    then(copied, info, std::move(film));
  });
  return grpc::Status::OK;
}

grpc::Status JobQueries::timeline(const v1::ListTimelineRequest& request,
                                  v1::ListTimelineResponse& response) {
  const auto known = context_.store->state(request.job());
  if (const grpc::Status there = job_is_there(request.job(), known); !there.ok()) return there;
  const uint32_t limit = request.limit() == 0 ? kMostSteps : std::min(request.limit(), kMostSteps);
  const Timelines::Page page = timelines_.page(request.job(), request.after(), limit);
  for (const TimedStep& step : page.steps) *response.add_steps() = to_wire(step);
  response.set_more(page.more);
  response.set_dropped(page.dropped);
  return grpc::Status::OK;
}

bool JobQueries::is_for_video(uint64_t job, const std::string& path) const {
  const StateLock lock(context_.mutex);
  const ActiveJob* active = jobs_.find(job);
  if (active == nullptr) return false;
  const std::vector<core::VideoDesc>& videos = active->videos;
  return std::any_of(videos.begin(), videos.end(), [&](const core::VideoDesc& video) {
    return path.starts_with(core::video_folder(video) + "/");
  });
}

}  // namespace hyades::coordinator
