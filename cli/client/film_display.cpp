#include "cli/client/film_display.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/display/shown_films.h"
#include "core/film/film_codec.h"
#include "core/image/read_image.h"

namespace hyades::cli {
namespace {

constexpr auto kLeast = std::chrono::seconds(1);
constexpr int kRestPerWork = 4;
constexpr auto kLastWords = std::chrono::seconds(10);
constexpr uint64_t kLargestFile = uint64_t{1} << 30U;

}  // namespace

FilmDisplay::FilmDisplay(std::unique_ptr<FarmClient> client, Viewer& viewer, uint64_t job)
    : client_(std::move(client)), viewer_(viewer), job_(job) {
  thread_ = std::thread([this] { run(); });
}

FilmDisplay::~FilmDisplay() {
  {
    const core::MutexLock lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void FilmDisplay::take(const v1::WatchEvent& event) {
  const core::MutexLock lock(mutex_);
  const bool first = name_.empty();
  name_ = event.job().name();
  several_ = event.job().frames() > 1;
  for (const v1::Frame& frame : event.changed()) {
    const int32_t number = frame.frame();
    switch (frame.state()) {
      case v1::FRAME_STATE_RENDERING:
      case v1::FRAME_STATE_FINISHING:
        in_work_[number].samples = frame.samples_done();
        break;
      case v1::FRAME_STATE_DONE:
        // Those that were finished before are of no interest, but where nothing else comes.
        if (first && event.job().state() == v1::JOB_STATE_RUNNING) break;
        if (const auto known = in_work_.extract(number);
            known && known.mapped().shown > 0 && known.mapped().shown == frame.samples()) {
          break;  // the viewer has all of it
        }
        done_.push_back(number);
        if (done_.size() > Viewer::kMostHeld) done_.pop_front();
        break;
      default:
        in_work_.erase(number);
    }
  }
  wake_.notify_one();
}

/// Of those that the viewer holds at once: the one whose film is oldest.
std::optional<int32_t> FilmDisplay::next_frame() const {
  std::optional<int32_t> next;
  uint64_t least = 0;
  size_t looked = 0;
  for (const auto& [number, frame] : in_work_) {
    if (++looked > Viewer::kMostHeld - 1) break;
    if (frame.samples == frame.shown) continue;
    if (next && frame.shown >= least) continue;
    next = number;
    least = frame.shown;
  }
  return next;
}

void FilmDisplay::run() {
  core::MutexLock lock(mutex_);
  std::optional<Clock::time_point> end;
  while (true) {
    while (!ending_ && done_.empty() && !next_frame()) wake_.wait(mutex_);
    if (ending_ && !end) end = Clock::now() + kLastWords;
    const Clock::time_point begin = Clock::now();
    if (!done_.empty()) {
      const int32_t frame = done_.front();
      done_.pop_front();
      lock.unlock();
      if (!show_film(frame)) show_exr(frame);
      lock.lock();
    } else if (const auto frame = ending_ ? std::nullopt : next_frame()) {
      const uint64_t samples = in_work_[*frame].samples;
      lock.unlock();
      const bool shown = show_film(*frame);
      lock.lock();
      if (const auto still = in_work_.find(*frame); still != in_work_.end() && shown) {
        still->second.shown = samples;
      }
    }
    if (end) {
      if (done_.empty() || Clock::now() >= *end) return;
      continue;
    }
    const Clock::duration rest =
        std::max<Clock::duration>(kLeast, kRestPerWork * (Clock::now() - begin));
    const Clock::time_point next = Clock::now() + rest;
    while (!ending_ && Clock::now() < next) wake_.wait_until(mutex_, next);
  }
}

bool FilmDisplay::show_film(int32_t frame) {
  v1::FilmHeader header;
  std::string bytes;
  if (client_->film(job_, frame, header, bytes)) return false;
  const auto film = core::decode_film(std::as_bytes(std::span(bytes)), client_->film_limits(bytes));
  if (!film || film->window().empty()) return false;
  show(frame, film->normalised());
  return true;
}

void FilmDisplay::show_exr(int32_t frame) {
  v1::OutputsRequest request;
  request.set_job(job_);
  v1::FrameRange& range = *request.add_frames();
  range.set_first(frame);
  range.set_last(frame);
  std::optional<v1::OutputFile> found;
  const Outcome listed = client_->outputs(request, [&](const v1::OutputFile& file) -> Outcome {
    if (!found && file.frame() == frame && file.path().ends_with(".exr")) found = file;
    return std::nullopt;
  });
  if (listed || !found || found->size() > kLargestFile) return;
  v1::FetchRequest fetch;
  fetch.set_job(job_);
  fetch.set_path(found->path());
  fetch.set_sha256(found->sha256());
  const auto file = std::make_shared<std::vector<std::byte>>();
  const Outcome fetched =
      client_->fetch(fetch, found->size(), [&](const std::string& piece) -> Outcome {
        const auto bytes = std::as_bytes(std::span(piece));
        file->insert(file->end(), bytes.begin(), bytes.end());
        return std::nullopt;
      });
  if (fetched) return;
  if (const auto picture = core::read_image(core::Bytes(file, *file), found->path())) {
    show(frame, *picture);
  }
}

void FilmDisplay::show(int32_t frame, const core::Image& picture) {
  std::string name;
  {
    const core::MutexLock lock(mutex_);
    name = picture_name(name_, frame, several_);
  }
  viewer_.put(name, picture.width, picture.height, picture, 0, 0);
}

}  // namespace hyades::cli
