#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/base/text.h"
#include "core/job/film_file.h"
#include "core/job/output_names.h"
#include "core/job/output_path.h"
#include "core/job/read_sections.h"

namespace hyades::core {

namespace {

void read_layers(MapReader& reader, OutputDesc& output) {
  output.layers = {"beauty", "alpha"};
  const auto names = layer_names();
  const YamlNode* node = reader.find("layers");
  if (node == nullptr) return;
  if (node->kind != YamlNode::Kind::list || node->list.empty()) {
    reader.mismatch("layers", *node, "a list of " + join_names(names));
    return;
  }
  std::vector<std::string> layers;
  for (const YamlPtr& item : node->list) {
    if (std::find(names.begin(), names.end(), item->scalar) == names.end()) {
      reader.complain(item->where,
                      fmt::format("layer is {}, expected {}{}", describe(*item), join_names(names),
                                  did_you_mean(item->scalar, names)));
    } else if (std::find(layers.begin(), layers.end(), item->scalar) != layers.end()) {
      reader.complain(item->where, fmt::format("layer '{}' is listed twice", item->scalar));
    } else {
      layers.push_back(item->scalar);
    }
  }
  output.layers = layers;
}

void read_exr(MapReader& reader, OutputDesc& output) {
  read_layers(reader, output);
  reader.flag("half", output.half);
}

void read_picture(MapReader& reader, OutputDesc& output) {
  reader.choice("tone_map", output.tone_map, tone_map_names());
  reader.number("exposure", output.exposure, {-64.0, 64.0});
}

void read_png(MapReader& reader, OutputDesc& output) {
  read_picture(reader, output);
  reader.flag("transparent", output.transparent);
}

struct FormatRow {
  const char* extension;
  const char* section;
  void (*read)(MapReader& reader, OutputDesc& output);
};

const std::array<FormatRow, 5> kFormats = {{
    {".exr", "outputs.exr", read_exr},
    {".png", "outputs.png", read_png},
    {".jpg", "outputs.jpg", read_picture},
    {".jpeg", "outputs.jpg", read_picture},
    {".mp4", "outputs.mp4", nullptr},
}};

void check_frame_marks(MapReader& reader, const SourceLocation& where, const std::string& file,
                       const FramesDesc& frames) {
  if (frames.first == frames.last || file.find('#') != std::string::npos) return;
  reader.complain(where, fmt::format("file is '{}', but the job has several frames: expected #### "
                                     "where the frame number goes",
                                     file));
}

/// A job says where below the output folder its pictures go; it has no say over the rest of the
/// disk.
void check_inside_folder(MapReader& reader, const SourceLocation& where, const std::string& file) {
  const std::string padded = "/" + file + "/";
  if (file.starts_with('/') || padded.find("/../") != std::string::npos) {
    reader.complain(where, fmt::format("file is '{}', expected a path below the output folder "
                                       "(no '..', not absolute); --output chooses the folder",
                                       file));
    return;
  }
  const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
  if (path.begin() != path.end() && *path.begin() == ".hyades") {
    reader.complain(where, fmt::format("file is '{}', expected another folder: what is in .hyades "
                                       "is removed with the run's log",
                                       file));
  }
}

void read_output(MapReader& reader, Job& job) {
  OutputDesc output;
  output.where = reader.where();
  reader.require("file", "a file name such as image.####.exr");
  reader.text("file", output.file, "a file name such as image.####.exr");
  if (reader.listing()) {
    for (const FormatRow& row : kFormats) {
      reader.enter_section(row.section);
      if (row.read != nullptr) row.read(reader, output);
    }
    return;
  }
  if (output.file.empty()) return;
  const SourceLocation where = reader.find("file")->where;
  const std::string extension = file_extension(output.file);
  const auto row = std::find_if(kFormats.begin(), kFormats.end(),
                                [&](const FormatRow& r) { return extension == r.extension; });
  if (row == kFormats.end() || row->read == nullptr) {
    const bool later = row != kFormats.end();
    reader.complain(
        where,
        fmt::format(
            "file is '{}', expected the ending .exr, .png, .jpg or .jpeg{}", output.file,
            later ? " (" + extension + " is not available in this version)" : std::string()));
    return;
  }
  check_frame_marks(reader, where, output.file, job.frames);
  check_inside_folder(reader, where, output.file);
  if (job.keep_films && (same_output_path(output.file, film_file(job)) ||
                         nested_output_paths(output.file, film_file(job)))) {
    reader.complain(where, fmt::format("file is '{}', where keep_films puts the film, expected "
                                       "another name",
                                       output.file));
  }
  reader.enter_section(row->section);
  row->read(reader, output);
  reader.finish();
  for (const OutputDesc& other : job.outputs) {
    if (same_output_path(other.file, output.file)) {
      reader.complain(where, fmt::format("file is '{}', which line {} writes already", output.file,
                                         other.where.line));
      return;
    }
    if (nested_output_paths(other.file, output.file)) {
      reader.complain(where, fmt::format("file is '{}', which cannot stand beside '{}' of line {}: "
                                         "one would be the other's folder",
                                         output.file, other.file, other.where.line));
      return;
    }
  }
  job.outputs.push_back(std::move(output));
}

void add_default_outputs(Job& job) {
  const std::string marks = job.frames.first == job.frames.last ? "" : ".####";
  OutputDesc exr;
  exr.file = job.name + marks + ".exr";
  exr.layers = {"beauty", "alpha"};
  OutputDesc png;
  png.file = job.name + marks + ".png";
  job.outputs = {exr, png};
}

}  // namespace

void read_outputs(MapReader& top, Job& job) {
  const YamlNode* node = top.find("outputs");
  if (top.listing()) {
    MapReader reader(top.context(), empty_map(), "", "", "outputs");
    read_output(reader, job);
    return;
  }
  if (node == nullptr) {
    add_default_outputs(job);
    return;
  }
  if (node->kind != YamlNode::Kind::list) {
    top.mismatch("outputs", *node, "a list such as [{file: image.####.exr}]");
    return;
  }
  if (node->list.size() > 100) {
    top.mismatch("outputs", *node, "at most 100 outputs");
    return;
  }
  for (size_t i = 0; i < node->list.size(); ++i) {
    MapReader reader(top.context(), *node->list[i], fmt::format("output {}", i + 1),
                     fmt::format("outputs[{}]", i), "outputs");
    if (node->list[i]->kind == YamlNode::Kind::map) read_output(reader, job);
  }
}

}  // namespace hyades::core
