#include "coordinator/web/pictures_api.h"

#include <algorithm>
#include <utility>

#include "coordinator/web/handing.h"
#include "coordinator/web/preview.h"
#include "core/image/read_image.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostKeptBytes = size_t{128} << 20U;
/// A picture of a frame in work is not made more often, however many samples have come.
constexpr std::chrono::milliseconds kFreshFor{1000};
constexpr int kNarrowest = 16;
constexpr int kWidest = 8192;

bool is_over(const v1::Frame& frame) { return frame.state() == v1::FRAME_STATE_DONE; }

/// How well a finished file shows a frame: 0 not at all.
int worth_of(const std::string& path, bool half) {
  if (path.ends_with(".film.exr")) return 0;
  if (path.ends_with(".exr")) return half ? 3 : 1;
  for (const char* ending : {".png", ".jpg", ".jpeg", ".tif", ".tiff"}) {
    if (path.ends_with(ending)) return 2;
  }
  return 0;
}

}  // namespace

PicturesApi::~PicturesApi() {
  const std::lock_guard lock(gate_->mutex);
  gate_->open = false;
}

void PicturesApi::add_routes(Router& router) {
  router.add(
      "GET", "/api/v1/jobs/{job}/frames/{frame}/picture",
      [this](const WebRequest& request, const Answer& answer) {
        const auto job = parameter<uint64_t>(request, "job", answer);
        if (!job) return;
        const auto frame = parameter<int32_t>(request, "frame", answer);
        if (!frame) return;
        const auto width = query_number<int>(request, "width", 0, answer);
        if (!width) return;
        Asked asked{*job, *frame, false, *width, "beauty"};
        if (*width != 0 && (*width < kNarrowest || *width > kWidest)) {
          answer(error_reply({grpc::StatusCode::INVALID_ARGUMENT,
                              fmt::format("width: expected {} to {}", kNarrowest, kWidest)}));
          return;
        }
        const auto format = request.query.find("format");
        if (format != request.query.end()) {
          asked.half = format->second == "half";
          if (!asked.half && format->second != "png") {
            answer(
                error_reply({grpc::StatusCode::INVALID_ARGUMENT, "format: expected png or half"}));
            return;
          }
        }
        const auto layer = request.query.find("layer");
        if (layer != request.query.end()) asked.layer = layer->second;
        const bool taken =
            desks_.files.hand([this, asked, answer] { answer_picture(asked, answer); });
        if (!taken) answer(error_reply(crowded()));
      });
}

void PicturesApi::answer_picture(const Asked& asked, const Answer& answer) {
  Brain::FrameNow now;
  if (const grpc::Status known = brain_.frame_now(asked.job, asked.frame, now); !known.ok()) {
    answer(error_reply(known));
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    const auto found = index_.find(asked);
    if (found != index_.end() && is_fresh(found->second->second, now)) {
      kept_.splice(kept_.begin(), kept_, found->second);
      answer(found->second->second.reply);
      return;
    }
    std::vector<Answer>& others = waiting_[asked];
    others.push_back(answer);
    if (others.size() > 1) return;
  }
  if (is_over(now.frame)) {
    make_of_file(asked, now);
  } else {
    make_of_film(asked, now);
  }
}

bool PicturesApi::is_fresh(const Made& made, const Brain::FrameNow& now) const {
  if (made.over != is_over(now.frame)) return false;
  if (made.samples_done == now.frame.samples_done()) return true;
  return std::chrono::steady_clock::now() - made.at < kFreshFor;
}

void PicturesApi::make_of_film(const Asked& asked, const Brain::FrameNow& now) {
  const grpc::Status status = brain_.film(
      asked.job, asked.frame,
      [this, gate = gate_, asked, now](const grpc::Status& found, const core::FilmInfo&,
                                       std::shared_ptr<const core::Film> film) {
        const std::lock_guard lock(gate->mutex);
        if (!gate->open) return;
        const bool taken = desks_.files.hand([this, asked, now, found, film = std::move(film)] {
          done(asked, now,
               found.ok() ? show(asked, now, film->normalised(), true) : error_reply(found));
        });
        if (!taken) done(asked, now, error_reply(crowded()));
      });
  // Done meanwhile, perhaps.
  if (status.error_code() == grpc::StatusCode::FAILED_PRECONDITION) {
    make_of_file(asked, now);
  } else if (!status.ok()) {
    done(asked, now, error_reply(status));
  }
}

void PicturesApi::make_of_file(const Asked& asked, const Brain::FrameNow& now) {
  const auto outputs = brain_.store().outputs_of(asked.job, asked.frame);
  if (!outputs) return done(asked, now, error_reply(farm::unavailable(outputs.error())));
  const StoredOutput* best = nullptr;
  for (const StoredOutput& output : *outputs) {
    if (worth_of(output.path, asked.half) == 0) continue;
    const bool better =
        best == nullptr || worth_of(output.path, asked.half) > worth_of(best->path, asked.half);
    if (better) best = &output;
  }
  if (best == nullptr) {
    return done(asked, now,
                error_reply({grpc::StatusCode::NOT_FOUND,
                             fmt::format("no picture of frame {} is kept", asked.frame)}));
  }
  const std::string path = brain_.output_folder(asked.job) + "/" + best->path;
  const auto image = core::read_image_file(path);
  if (!image) {
    return done(asked, now,
                error_reply({grpc::StatusCode::DATA_LOSS,
                             best->path + " is damaged on the coordinator's disk"}));
  }
  Brain::FrameNow plain = now;
  plain.tone_map = "srgb";  // a finished picture has its own
  plain.exposure = 0;
  done(asked, now, show(asked, plain, *image, best->path.ends_with(".exr")));
}

WebReply PicturesApi::show(const Asked& asked, const Brain::FrameNow& now, const core::Image& image,
                           bool exact) const {
  const auto layer = take_layer(image, asked.layer);
  if (!layer) return error_reply({grpc::StatusCode::NOT_FOUND, layer.error().message});
  const core::Image shown = asked.width > 0 ? shrink(*layer, asked.width) : *layer;
  WebReply reply;
  if (asked.half) {
    reply = text_reply(
        half_planes(shown, {asked.layer, layers_of(image), now.frame.samples_done(), exact}),
        "application/octet-stream");
  } else {
    const auto curve = core::find_tone_curve(now.tone_map);
    const auto png = display_png(shown, curve.value_or(core::ToneCurve::srgb), now.exposure);
    if (!png) return error_reply({grpc::StatusCode::INVALID_ARGUMENT, png.error().message});
    reply = text_reply(std::string(png->chars(), png->size()), "image/png");
  }
  reply.headers = {{"Cache-Control", "private, no-cache"},
                   {"ETag", fmt::format("\"{}-{}{}\"", now.frame.samples_done(),
                                        is_over(now.frame) ? "done" : "", now.frame.restarts())}};
  return reply;
}

/// Everybody who waits for the picture gets it.
void PicturesApi::done(const Asked& asked, const Brain::FrameNow& now, const WebReply& reply) {
  std::vector<Answer> answers;
  {
    const std::lock_guard lock(mutex_);
    answers = std::move(waiting_[asked]);
    waiting_.erase(asked);
    if (reply.status == 200) {
      const auto old = index_.find(asked);
      if (old != index_.end()) {
        kept_bytes_ -= old->second->second.reply.text->size();
        kept_.erase(old->second);
      }
      kept_.emplace_front(asked, Made{now.frame.samples_done(), is_over(now.frame),
                                      std::chrono::steady_clock::now(), reply});
      index_[asked] = kept_.begin();
      kept_bytes_ += reply.text->size();
      while (kept_bytes_ > kMostKeptBytes && kept_.size() > 1) {
        kept_bytes_ -= kept_.back().second.reply.text->size();
        index_.erase(kept_.back().first);
        kept_.pop_back();
      }
    }
  }
  for (const Answer& answer : answers) answer(reply);
}

}  // namespace hyades::coordinator
