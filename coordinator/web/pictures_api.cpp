#include "coordinator/web/pictures_api.h"

#include <algorithm>
#include <string>
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

/// What a picture is made of.
struct Shot {
  const core::Image& image;
  const SampledMask& sampled;
  bool exact = true;  ///< linear, and not cut to 8 bits
};

/// The picture that `asked` means.
WebReply show(const AskedPicture& asked, const FrameNow& now, const Shot& shot,
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
        const AskedPicture asked{request.job(),
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
        const PictureAsker asker{owner_of(from.caller), answer};
        const bool taken = pool_.submit(
            [this, asked, asker] {
              answer_picture(asked, asker);
              begin_some();
            },
            asker.owner.name);
        if (!taken) answer(error_reply(crowded()));
      });
}

void PicturesApi::answer_picture(const AskedPicture& asked, const PictureAsker& asker) {
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
  if (!kept_.has_room(asker.owner)) return asker.answer(too_many());
  if (auto made = kept_.find(asked, tag, over)) {
    return asker.answer(kept_.reply_for(asker.owner, std::move(*made), too_many()));
  }
  if (!turns_.add(asked, asker)) asker.answer(error_reply(crowded()));
}

/// The finished file that shows best what is asked for; nothing where none shows it.
core::Result<std::optional<StoredOutput>> PicturesApi::best_file(const AskedPicture& asked) {
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

grpc::Status PicturesApi::of_file(const AskedPicture& asked, const FrameNow& now,
                                  std::optional<OpenFile>& open, WebReply& reply) {
  const auto best = best_file(asked);
  if (!best) return farm::unavailable(best.error());
  if (!*best) {
    return {grpc::StatusCode::NOT_FOUND,
            fmt::format("no picture of frame {} is kept", asked.frame)};
  }
  const StoredOutput& file = **best;
  const std::string tag = tag_of(file);
  if (auto made = kept_.find(asked, tag, true)) {
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
  kept_.keep(asked, tag, true, reply);
  return grpc::Status::OK;
}

void PicturesApi::begin_some() {
  while (const auto id = turns_.begin_next()) take(*id);
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
  if (lacks_room(status) && !turns_.is_alone(id)) return leave(id, {}, true);
  // Done meanwhile: those who ask again get the finished picture.
  if (status.error_code() == grpc::StatusCode::FAILED_PRECONDITION) {
    status = farm::retry_later(grpc::StatusCode::UNAVAILABLE, "the frame is being finished",
                               std::chrono::milliseconds(500));
  }
  end(id, error_reply(status));
}

void PicturesApi::take_files(JobAndFrame id, const FrameNow& now) {
  make_wanted(id, [this, now, open = std::optional<OpenFile>()](const AskedPicture& asked,
                                                                WebReply& reply) mutable {
    return of_file(asked, now, open, reply);
  });
}

void PicturesApi::make_all(JobAndFrame id, const FrameNow& now, const grpc::Status& found,
                           std::shared_ptr<const core::Film> film) {
  if (lacks_room(found) && !turns_.is_alone(id)) return leave(id, {}, true);
  if (!found.ok()) return end(id, error_reply(found));
  core::Image image;
  SampledMask sampled;
  const grpc::Status made = within_memory([&] {
    image = film->normalised();
    sampled = sampled_pixels(*film);
    return grpc::Status::OK;
  });
  make_wanted(id, [this, now, made, room = std::move(film), image = std::move(image),
                   sampled = std::move(sampled)](const AskedPicture& asked, WebReply& reply) {
    if (!made.ok()) return made;
    reply = show(asked, now, {image, sampled}, now.tag);
    kept_.keep(asked, now.tag, false, reply);
    return grpc::Status::OK;
  });
}

/// Makes what is wanted of the frame by now, until its turn is over: those who wait share it, by
/// whomever it has come. What finds no memory beside another frame is made in a turn alone.
void PicturesApi::make_wanted(JobAndFrame id, Make make) {
  const bool alone = turns_.is_alone(id);
  WantedPictures wanted = turns_.take_wanted(id);
  bool no_room = false;
  for (bool over = wanted.empty(); !over;) {
    const auto next = turns_.next_of(id, wanted);
    const auto& [asked, askers] = *next;
    WebReply reply;
    no_room = !make_one(asked, askers, make, reply) && !alone;
    if (no_room) break;
    turns_.charge(id, askers);
    for (const PictureAsker& asker : askers) {
      asker.answer(kept_.reply_for(asker.owner, reply, too_many()));
    }
    wanted.erase(next);
    over = wanted.empty() || turns_.gives_way(id, wanted);
  }
  make = nullptr;  // who is next needs its room
  leave(id, wanted, no_room);
}

/// Makes `reply`, which those who have asked are told. False where there is no memory for it: of
/// all that may be wrong nothing else is better in a turn alone.
bool PicturesApi::make_one(const AskedPicture& asked, const PictureAskers& askers, const Make& make,
                           WebReply& reply) {
  const bool wanted = std::any_of(askers.begin(), askers.end(), [&](const PictureAsker& asker) {
    return kept_.has_room(asker.owner);
  });
  if (is_closed() || !wanted) {
    reply = is_closed() ? closing() : too_many();
    return true;
  }
  const grpc::Status made = within_memory([&] { return make(asked, reply); });
  if (!made.ok()) reply = error_reply(made);
  return !lacks_room(made);
}

/// Everybody who waits for pictures of the frame is told this.
void PicturesApi::end(JobAndFrame id, const WebReply& reply) {
  for (const auto& [asked, askers] : turns_.take_wanted(id)) {
    for (const PictureAsker& asker : askers) asker.answer(reply);
  }
  leave(id, {}, false);
}

/// The frame's turn is over, as of PictureTurns::end(), and the next begins.
void PicturesApi::leave(JobAndFrame id, const WantedPictures& left, bool no_room) {
  turns_.end(id, left, no_room);
  // Where so much waits that this may not, whatever is asked for next begins with what is next.
  (void)pool_.submit([this] { begin_some(); });
}

}  // namespace hyades::coordinator
