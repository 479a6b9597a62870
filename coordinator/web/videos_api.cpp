#include "coordinator/web/videos_api.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/services/ownership.h"
#include "coordinator/web/handing.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

farm::Json to_json(const AskedVideo& video) {
  return {{"id", video.number},
          {"file", video.video.file},
          {"pictures", video.video.pictures},
          {"frames", video.frames.numbers.size()},
          {"rate", video.frames.rate},
          {"state", name_of(video.state)},
          {"reason", video.reason}};
}

/// What a body asks for; the error names the field.
core::Result<VideoWish> read_wish(const std::string& body) {
  VideoWish wish;
  if (body.empty()) return wish;
  const auto json = farm::Json::parse(body, nullptr, false);
  if (!json.is_object()) return core::Error{"expected an object: {\"file\": \"film.mp4\"}"};
  for (const auto& [name, value] : json.items()) {
    if (name == "file" || name == "pictures") {
      if (!value.is_string()) return core::Error{name + ": expected a text"};
      (name == "file" ? wish.file : wish.pictures) = value.get<std::string>();
    } else if (name == "rate") {
      if (!value.is_number()) return core::Error{"rate: expected a number"};
      wish.rate = value.get<double>();
    } else {
      return core::Error{"'" + name + "': expected file, pictures or rate"};
    }
  }
  return wish;
}

}  // namespace

void VideosApi::add_routes(Router& router) {
  router.add("GET", "/api/v1/jobs/{job}/videos",
             of_job_by(executors_.rows, [this](uint64_t job) { return list(job); }));
  router.add("POST", "/api/v1/jobs/{job}/videos",
             of_job([this](uint64_t job, const WebRequest& request, const Answer& answer) {
               auto wish = read_wish(request.body);
               if (!wish) {
                 answer(error_reply({grpc::StatusCode::INVALID_ARGUMENT, wish.error().message}));
                 return;
               }
               answer_by(executors_.files, answer,
                         [this, job, wish = std::move(*wish), caller = request.caller] {
                           return ask(caller, job, wish);
                         });
             }));
}

WebReply VideosApi::list(uint64_t job) {
  std::vector<AskedVideo> videos;
  if (const grpc::Status known = controller_.videos().asked(job, videos); !known.ok()) {
    return error_reply(known);
  }
  farm::Json all = farm::Json::array();
  for (const AskedVideo& video : videos) all.push_back(to_json(video));
  return json_reply({{"videos", std::move(all)}});
}

WebReply VideosApi::ask(const Caller& caller, uint64_t job, const VideoWish& wish) {
  if (const grpc::Status his = may_steer(controller_, caller, job); !his.ok())
    return error_reply(his);
  AskedVideo video;
  const grpc::Status taken = controller_.videos().ask(job, wish, video);
  if (!taken.ok()) return error_reply(taken);
  WebReply reply = json_reply(to_json(video));
  reply.status = 202;
  return reply;
}

}  // namespace hyades::coordinator
