#include "coordinator/finisher/finish_task.h"

#include <filesystem>
#include <system_error>

#include "coordinator/finisher/json_file.h"
#include "core/film/film_codec.h"

namespace hyades::coordinator {
using Json = nlohmann::json;

namespace {

/// Configurations name files above themselves (../luts/a.cube), up to so many folders.
constexpr const char* kBelow = "/color/1/2/3/4/5/6/7/8/";

std::string color_path(const std::string& folder, const std::string& config) {
  return folder + kBelow + std::filesystem::path(config).filename().string();
}

/// Puts a file of the colour configuration to where it lies to the configuration as in the job.
core::Status put_color_file(const std::string& folder, const std::string& config,
                            const std::string& reference, const core::Bytes& bytes) {
  const std::filesystem::path from = std::filesystem::path(config).parent_path();
  const auto relative = std::filesystem::path(reference).lexically_relative(
      from.empty() ? std::filesystem::path(".") : from);
  const auto path = (std::filesystem::path(folder + kBelow) / relative).lexically_normal();
  if (relative.empty() || !path.string().starts_with(folder + "/color/")) {
    return core::Error{"the colour configuration names " + reference +
                       ", which lies nowhere near it"};
  }
  std::error_code failed;
  std::filesystem::create_directories(path.parent_path(), failed);
  if (failed) return core::Error{path.string() + ": " + failed.message()};
  return core::write_file(path.string(), bytes.span());
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
                       {"denoise", output.denoise},
                       {"half", output.half},
                       {"quality", output.quality},
                       {"bits", output.bits},
                       {"transparent", output.transparent}});
  }
  const core::FilmInfo& info = task.info;
  Json json = {{"job", info.job_name},
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
  if (const auto& color = task.color) {
    json["color"] = {{"config", color_path(folder, color->config)},
                     {"display", color->display},
                     {"view", color->view},
                     {"look", color->look},
                     {"working_space", color->working_space}};
    for (const auto& [reference, bytes] : task.color_files) {
      if (auto put = put_color_file(folder, color->config, reference, bytes); !put) return put;
    }
  }
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
    if (json->contains("color")) {
      const Json& named = json->at("color");
      core::ColorDesc& color = task.color.emplace();
      color.config = named.at("config");
      color.display = named.at("display");
      color.view = named.at("view");
      color.look = named.at("look");
      color.working_space = named.at("working_space");
    }
    for (const Json& entry : json->at("outputs")) {
      core::OutputDesc output;
      output.file = entry.at("file");
      output.layers = entry.at("layers").get<std::vector<std::string>>();
      output.tone_map = entry.at("tone_map");
      output.exposure = entry.at("exposure");
      output.denoise = entry.at("denoise");
      output.half = entry.at("half");
      output.quality = entry.at("quality");
      output.bits = entry.at("bits");
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
