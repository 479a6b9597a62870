#include "coordinator/web/job_events.h"

#include <algorithm>
#include <utility>

#include "coordinator/controller/within_memory.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/live_readers.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

/// Frames that are read at once [bytes of messages]. As JSON they are up to twelve times as large.
constexpr size_t kFrameBytes = size_t{8} << 10U;
constexpr uint64_t kTextBytes = 16 * kFrameBytes;

std::string text_of(const farm::Json& json) {
  return json.dump(-1, ' ', false, farm::Json::error_handler_t::replace);
}

farm::Json frames_of(const v1::WatchEvent& event) {
  farm::Json frames = farm::Json::array();
  for (const v1::Frame& frame : event.changed()) frames.push_back(farm::to_json(frame));
  return frames;
}

}  // namespace

JobEvents::JobEvents(Controller& controller, uint64_t job) : controller_(controller), job_(job) {
  cursor_.page_bytes = kFrameBytes;
  watch_ = controller_.watchers().watch(job_, [changed = changed_] { *changed = true; });
}

JobEvents::~JobEvents() { controller_.watchers().unwatch(watch_); }

uint64_t JobEvents::bytes_needed() const { return text_.empty() ? kTextBytes : kPieceBytes; }

std::optional<std::string> JobEvents::next() {
  // Changes are told twice a second at most.
  if (text_.empty() && std::exchange(rests_, false)) return std::string();
  if (text_.empty() && !over_) {
    const grpc::Status read_now = within_memory([&] { return read(); });
    if (read_now.error_code() == grpc::StatusCode::NOT_FOUND && (told_ || !begun_)) {
      text_ = *LiveReaders::event("gone", {{"message", read_now.error_message()}});
      over_ = true;
    } else if (!read_now.ok()) {
      // The store does not answer, say: again, but in the midst of a snapshot from the beginning.
      *changed_ = true;
      if (begun_ && !told_) return std::nullopt;
    }
  }
  const size_t count = std::min(text_.size(), kPieceBytes);
  std::string piece = text_.substr(0, count);
  text_.erase(0, count);
  if (text_.empty()) text_.shrink_to_fit();
  return piece;
}

/// The next page, as text.
grpc::Status JobEvents::read() {
  *changed_ = false;
  const ChangeCursor before = cursor_;
  v1::WatchEvent event;
  bool ended = false;
  grpc::Status status = controller_.queries().changes(job_, cursor_, event, ended);
  if (!status.ok()) return status;
  if (event.more()) *changed_ = true;
  ended_ = ended && !event.more();
  if (told_) {
    read_change(event, before);
  } else {
    read_snapshot(event);
  }
  return status;
}

/// It is one event, however many pages it has.
void JobEvents::read_snapshot(const v1::WatchEvent& event) {
  if (!std::exchange(begun_, true)) text_ = "event: snapshot\ndata: {\"frames\":[";
  for (const v1::Frame& frame : event.changed()) {
    if (std::exchange(has_frames_, true)) text_ += ',';
    text_ += text_of(farm::to_json(frame));
  }
  if (event.more()) return;
  told_ = true;
  const farm::Json job = farm::to_json(event.job());
  text_ += "],\"job\":" + text_of(job) + "}\n\n";
  if (!ended_) return;
  text_ += *LiveReaders::event("end", {{"job", job}, {"frames", farm::Json::array()}});
  over_ = true;
}

void JobEvents::read_change(const v1::WatchEvent& event, const ChangeCursor& before) {
  const bool news =
      ended_ || event.changed_size() > 0 || event.more() || cursor_.version != before.version;
  if (!news) return;
  text_ = *LiveReaders::event(ended_ ? "end" : "change",
                              {{"job", farm::to_json(event.job())}, {"frames", frames_of(event)}});
  over_ = ended_;
  rests_ = !event.more() && !over_;
}

}  // namespace hyades::coordinator
