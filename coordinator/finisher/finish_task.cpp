#include "coordinator/finisher/finish_task.h"

#include <filesystem>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "coordinator/finisher/json_file.h"
#include "core/film/film_codec.h"
#include "core/job/made_file.h"
#include "core/job/output_path.h"

namespace hyades::core {

// What a finisher is told of outputs and colours: each key once, for writing and for reading.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OutputDesc, file, layers, tone_map, exposure, denoise, half,
                                   jpeg_quality, bits, transparent)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ColorDesc, config, display, view, look, working_space)

}  // namespace hyades::core

namespace hyades::coordinator {
using Json = nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FinishedFile, path, size, sha256)

namespace {

constexpr uint64_t kOneResult = 512;    ///< bytes of what is told of a file, without its path
constexpr uint64_t kLongestEscape = 6;  ///< of a byte in JSON

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

/// The JSON that the finisher has left, as far as it is of a length that fits to the files.
core::Result<Json> read_result_json(const std::string& folder,
                                    const std::vector<std::string>& files) {
  uint64_t most = kOneResult;
  for (const std::string& file : files) most += kOneResult + kLongestEscape * file.size();
  const auto file = core::MadeFile::find(folder, "result.json");
  if (!file) return file.error();
  const auto bytes = file->read_whole(most);
  if (!bytes) return bytes.error();
  Json json = Json::parse(bytes->chars(), bytes->chars() + bytes->size(), nullptr, false);
  if (json.is_discarded()) return core::Error{"not JSON"};
  return json;
}

/// Whether the file is there as the finisher says.
core::Status check_file(const std::string& outputs, const FinishedFile& told) {
  const auto file = core::MadeFile::find(outputs, told.path);
  if (!file) return file.error();
  if (file->size() != told.size) {
    return core::Error{fmt::format("has {} bytes, not {}", file->size(), told.size)};
  }
  if (told.sha256.size() != 64 ||
      told.sha256.find_first_not_of("0123456789abcdef") != std::string::npos) {
    return core::Error{"its SHA-256 is none"};
  }
  return {};
}

}  // namespace

core::Status write_finish_task(const std::string& folder, const FinishTask& task,
                               const core::Film& film) {
  const core::FilmInfo& info = task.info;
  Json json = {{"job", info.job_name},
               {"render_key", info.render_key},
               {"frame", info.frame},
               {"size", {info.width, info.height}},
               {"crop", {info.crop.x0, info.crop.y0, info.crop.x1, info.crop.y1}},
               {"samples", info.samples},
               {"noise", {info.aim.noise, info.aim.exposure, info.aim.min_samples}},
               {"class", info.worker_class},
               {"build", info.build},
               {"film", task.film},
               {"folder", task.folder},
               {"outputs", task.outputs}};
  if (const auto& color = task.color) {
    json["color"] = *color;
    json["color"]["config"] = color_path(folder, color->config);
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
    const Json& aim = json->at("noise");
    info.aim = {aim.at(0), aim.at(1), aim.at(2)};
    info.worker_class = json->at("class");
    info.build = json->at("build");
    task.film = json->at("film");
    task.folder = json->at("folder");
    if (json->contains("color")) task.color = json->at("color").get<core::ColorDesc>();
    task.outputs = json->at("outputs").get<std::vector<core::OutputDesc>>();
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

std::string told_path(const std::string& folder, const std::string& path) {
  return std::filesystem::path(path).lexically_relative(folder).string();
}

std::vector<std::string> files_of(const FinishTask& task) {
  std::vector<std::string> files;
  const auto add = [&](const std::string& file) {
    files.push_back(
        told_path(task.folder, task.folder + "/" + core::output_path(file, task.info.frame)));
  };
  for (const core::OutputDesc& output : task.outputs) add(output.file);
  if (!task.film.empty()) add(task.film);
  return files;
}

core::Status write_finish_result(const std::string& folder,
                                 const std::vector<FinishedFile>& files) {
  return write_json(folder + "/result.json", files);
}

core::Result<std::vector<FinishedFile>> read_finish_result(const std::string& folder,
                                                           const std::string& outputs,
                                                           const std::vector<std::string>& files) {
  const auto json = read_result_json(folder, files);
  if (!json) return json.error().in("the finisher's result");
  std::vector<FinishedFile> made;
  try {
    made = json->get<std::vector<FinishedFile>>();
  } catch (const Json::exception& e) {
    return core::Error{std::string("the finisher's result: ") + e.what()};
  }
  std::set<std::string> left(files.begin(), files.end());
  for (const FinishedFile& file : made) {
    if (left.erase(file.path) == 0) {
      return core::Error{"the finisher tells of a file that it was not to make: '" + file.path +
                         "'"};
    }
    if (core::Status right = check_file(outputs, file); !right) {
      return right.error().in("the finisher's " + file.path);
    }
  }
  return made;
}

}  // namespace hyades::coordinator
