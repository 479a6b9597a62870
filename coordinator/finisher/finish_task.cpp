#include "coordinator/finisher/finish_task.h"

#include <span>

#include <nlohmann/json.hpp>

#include "core/base/assets.h"
#include "core/base/atomic_file.h"
#include "core/film/film_codec.h"

namespace hyades::coordinator {
namespace {

using Json = nlohmann::json;

core::Status write_json(const std::string& path, const Json& json) {
  const std::string text = json.dump(2);
  return core::write_file(path, std::as_bytes(std::span(text)));
}

core::Result<Json> read_json(const std::string& path) {
  auto bytes = core::map_file(path);
  if (!bytes) return bytes.error().in(path);
  Json json = Json::parse(bytes->chars(), bytes->chars() + bytes->size(), nullptr, false);
  if (json.is_discarded()) return core::Error{path + ": not JSON"};
  return json;
}

}  // namespace

core::Status write_finish_task(const std::string& folder, const FinishTask& task,
                               const core::Film& film) {
  Json outputs = Json::array();
  for (const core::OutputDesc& output : task.outputs) {
    outputs.push_back({{"file", output.file},
                       {"layers", output.layers},
                       {"tone_map", output.tone_map},
                       {"exposure", output.exposure},
                       {"half", output.half},
                       {"transparent", output.transparent}});
  }
  const core::FilmInfo& info = task.info;
  const Json json = {{"job", info.job_name},
                     {"render_key", info.render_key},
                     {"frame", info.frame},
                     {"size", {info.width, info.height}},
                     {"crop", {info.crop.x0, info.crop.y0, info.crop.x1, info.crop.y1}},
                     {"samples", info.samples},
                     {"class", info.worker_class},
                     {"build", info.build},
                     {"film", task.film},
                     {"folder", task.folder},
                     {"outputs", outputs}};
  if (auto written = write_json(folder + "/task.json", json); !written) return written;
  return core::write_file(folder + "/film.bin", core::encode_film(film));
}

core::Result<FinishTask> read_finish_task(const std::string& folder) {
  const std::string path = folder + "/task.json";
  const auto json = read_json(path);
  if (!json) return json.error();
  try {
    FinishTask task;
    core::FilmInfo& info = task.info;
    info.job_name = json->at("job");
    info.render_key = json->at("render_key");
    info.frame = json->at("frame");
    info.width = json->at("size").at(0);
    info.height = json->at("size").at(1);
    const Json& crop = json->at("crop");
    info.crop = {crop.at(0), crop.at(1), crop.at(2), crop.at(3)};
    info.samples = json->at("samples");
    info.worker_class = json->at("class");
    info.build = json->at("build");
    task.film = json->at("film");
    task.folder = json->at("folder");
    for (const Json& entry : json->at("outputs")) {
      core::OutputDesc output;
      output.file = entry.at("file");
      output.layers = entry.at("layers").get<std::vector<std::string>>();
      output.tone_map = entry.at("tone_map");
      output.exposure = entry.at("exposure");
      output.half = entry.at("half");
      output.transparent = entry.at("transparent");
      task.outputs.push_back(std::move(output));
    }
    return task;
  } catch (const Json::exception& e) {
    return core::Error{path + ": " + e.what()};
  }
}

core::Result<core::Film> read_finish_film(const std::string& folder) {
  auto bytes = core::map_file(folder + "/film.bin");
  if (!bytes) return bytes.error().in(folder + "/film.bin");
  return core::decode_film(bytes->span());
}

core::Status write_finish_result(const std::string& folder,
                                 const std::vector<FinishedFile>& files) {
  Json json = Json::array();
  for (const FinishedFile& file : files) {
    json.push_back({{"path", file.path}, {"size", file.size}, {"sha256", file.sha256}});
  }
  return write_json(folder + "/result.json", json);
}

core::Result<std::vector<FinishedFile>> read_finish_result(const std::string& folder) {
  const std::string path = folder + "/result.json";
  const auto json = read_json(path);
  if (!json) return json.error();
  try {
    std::vector<FinishedFile> files;
    for (const Json& entry : *json) {
      files.push_back({entry.at("path"), entry.at("size"), entry.at("sha256")});
    }
    return files;
  } catch (const Json::exception& e) {
    return core::Error{path + ": " + e.what()};
  }
}

}  // namespace hyades::coordinator
