#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/assets.h"
#include "core/base/text.h"
#include "core/job/output_names.h"
#include "core/job/output_path.h"
#include "core/job/output_places.h"
#include "core/job/read_layers.h"
#include "core/job/read_sections.h"

namespace hyades::core {
namespace {

void read_exr(MapReader& reader, OutputDesc& output) {
  read_layers(reader, output);
  reader.flag("half", output.half);
  output.exposure = reader.context().exposure;  // of its previews: the numbers stay
}

void read_picture(MapReader& reader, OutputDesc& output) {
  if (reader.context().job.color && reader.has("tone_map")) {
    reader.complain(reader.where_of("tone_map"),
                    "tone_map stands beside 'color', whose configuration makes the display values; "
                    "expected one of them");
  }
  if (reader.listing()) reader.tell("layer", {.takes = "text", .start = "\"beauty\""});
  const YamlNode* layer = reader.find("layer");
  if (layer != nullptr && check_layer(reader, *layer)) {
    if (unfolded(layer->scalar).size() > 1 || layer->scalar == "light_groups") {
      reader.mismatch("layer", *layer, "one layer; this one stands for several");
    } else if (layer->scalar != "beauty") {
      output.layers = {layer->scalar};
    }
  }
  reader.choice("tone_map", output.tone_map, tone_map_names());
  reader.number("exposure", output.exposure, {-64.0, 64.0});
  output.exposure += reader.context().exposure;
}

/// PNG and TIFF.
void read_lossless(MapReader& reader, OutputDesc& output) {
  static const std::array<std::string, 2> kBits = {"8", "16"};
  read_picture(reader, output);
  reader.flag("transparent", output.transparent);
  std::string bits = kBits[0];
  reader.choice("bits", bits, kBits);
  output.bits = bits == kBits[1] ? 16 : 8;
}

void read_jpeg(MapReader& reader, OutputDesc& output) {
  read_picture(reader, output);
  reader.integer("quality", output.jpeg_quality, 1, 100);
}

/// Constant rate factors of an encoder.
struct RateFactors {
  int32_t usual;
  int32_t best;
  int32_t worst;
};

/// Without x264's 0, which needs a profile that few players have.
constexpr RateFactors kH264{18, 1, 51};
constexpr RateFactors kVp9{24, 0, 63};

struct FormatRow {
  const char* extension;
  const char* section;
  void (*read)(MapReader& reader, OutputDesc& output);  ///< keys of what each frame leaves
  const RateFactors* video = nullptr;                   ///< null: pictures only

  void read_keys(MapReader& reader, OutputDesc& output, VideoDesc& made) const {
    read(reader, output);
    if (video == nullptr) return;
    made.rate_factor = video->usual;
    reader.integer("quality", made.rate_factor, video->best, video->worst);
  }
};

const std::array<FormatRow, 9> kFormats = {{
    {".exr", "outputs.exr", read_exr},
    {".png", "outputs.png", read_lossless},
    {".tif", "outputs.tiff", read_lossless},
    {".tiff", "outputs.tiff", read_lossless},
    {".jpg", "outputs.jpg", read_jpeg},
    {".jpeg", "outputs.jpg", read_jpeg},
    {".mp4", "outputs.mp4", read_picture, &kH264},
    {".mov", "outputs.mp4", read_picture, &kH264},
    {".webm", "outputs.webm", read_picture, &kVp9},
}};

/// Puts `video` among the job's videos, and the picture that each frame leaves for it among the
/// frame's outputs.
void add_video(MapReader& reader, const SourceLocation& where, VideoDesc video, OutputDesc output,
               Job& job) {
  video.where = output.where;
  video.file = output.file;
  video.pictures = output.file + ".frames/####.png";
  output.file = video.pictures;
  if (!has_own_place(reader, where, output.file, job)) return;
  job.outputs.push_back(std::move(output));
  job.videos.push_back(std::move(video));
}

void read_output(MapReader& reader, Job& job) {
  OutputDesc output;
  VideoDesc video;
  output.where = reader.where();
  reader.require("file", "a file name such as image.####.exr");
  reader.text("file", output.file, "a file name such as image.####.exr");
  output.denoise = job.denoise;
  reader.choice("denoise", output.denoise, denoise_names());
  if (reader.listing()) {
    for (const FormatRow& row : kFormats) {
      reader.enter_type(row.section);
      row.read_keys(reader, output, video);
    }
    return;
  }
  if (output.file.empty()) return;
  const SourceLocation where = reader.where_of("file");
  if (output.file.size() > kLongestFileName) {
    return reader.complain(where, fmt::format("file is a name of {} bytes, expected at most {}",
                                              output.file.size(), kLongestFileName));
  }
  const std::string extension = file_extension(output.file);
  const auto row = std::find_if(kFormats.begin(), kFormats.end(),
                                [&](const FormatRow& r) { return extension == r.extension; });
  if (row == kFormats.end()) {
    reader.complain(where, fmt::format("file is '{}', expected the ending {}", output.file,
                                       join_names(output_endings())));
    return;
  }
  check_frame_marks(reader, where, output.file, job.frames, row->video != nullptr);
  check_inside_folder(reader, where, output.file);
  reader.enter_section(row->section);
  row->read_keys(reader, output, video);
  reader.finish();
  if (extension != ".exr" && output.file.find(kLayerMark) != std::string::npos) {
    return reader.complain(where,
                           fmt::format("file is '{}', but {} is for .exr files; expected key "
                                       "layer beside a name without it",
                                       output.file, kLayerMark));
  }
  if (row->video != nullptr) {
    if (has_own_place(reader, where, output.file, job)) {
      add_video(reader, where, std::move(video), std::move(output), job);
    }
    return;
  }
  for (OutputDesc& one : split_by_layer(job, output)) {
    if (has_own_place(reader, where, one.file, job)) job.outputs.push_back(std::move(one));
  }
}

void add_default_outputs(Job& job, float exposure) {
  const std::string marks = job.frames.first == job.frames.last ? "" : ".####";
  OutputDesc exr;
  exr.file = job.name + marks + ".exr";
  exr.layers = {"beauty", "alpha"};
  OutputDesc png;
  png.file = job.name + marks + ".png";
  png.exposure = exposure;
  exr.denoise = png.denoise = job.denoise;
  job.outputs = {exr, png};
}

}  // namespace

std::span<const std::string> output_endings() {
  static const std::vector<std::string> kEndings = [] {
    std::vector<std::string> endings;
    for (const FormatRow& row : kFormats) endings.emplace_back(row.extension);
    return endings;
  }();
  return kEndings;
}

void read_outputs(MapReader& top, Job& job) {
  const YamlNode* node = top.find("outputs");
  if (top.listing()) {
    top.tell("outputs", {.takes = "list", .below = "outputs"});
    MapReader reader(top.context(), empty_map(), "", "", "outputs");
    read_output(reader, job);
    return;
  }
  if (node == nullptr) {
    add_default_outputs(job, top.context().exposure);
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
