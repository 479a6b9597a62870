#include "coordinator/finisher/video_task.h"

#include <cstdint>
#include <vector>

#include "coordinator/finisher/finish_task.h"
#include "coordinator/finisher/json_file.h"

namespace hyades::coordinator {

using Json = nlohmann::json;

std::vector<std::string> files_of(const VideoTask& task) {
  const std::string& folder = task.frames.folder;
  return {told_path(folder, folder + "/" + task.video.file)};
}

core::Status write_video_task(const std::string& folder, const VideoTask& task) {
  const Json json = {{"file", task.video.file},           {"pictures", task.video.pictures},
                     {"quality", task.video.rate_factor}, {"folder", task.frames.folder},
                     {"numbers", task.frames.numbers},    {"rate", task.frames.rate}};
  return write_json(folder + "/video.json", json);
}

core::Result<VideoTask> read_video_task(const std::string& folder) {
  const std::string path = folder + "/video.json";
  const auto json = read_json(path);
  if (!json) return json.error();
  try {
    VideoTask task;
    task.video.file = json->at("file");
    task.video.pictures = json->at("pictures");
    task.video.rate_factor = json->at("quality");
    task.frames.folder = json->at("folder");
    task.frames.numbers = json->at("numbers").get<std::vector<int32_t>>();
    task.frames.rate = json->at("rate");
    return task;
  } catch (const Json::exception& e) {
    return core::Error{path + ": " + e.what()};
  }
}

}  // namespace hyades::coordinator
