#include "cli/output_note.h"

#include <algorithm>
#include <fstream>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/base/atomic_file.h"
#include "core/base/hash.h"

namespace hyades::cli {
namespace {

/// Names in the colour configuration, and the bytes of its files.
std::string color_settings(const LoadedJob& loaded) {
  const auto& color = loaded.job.color;
  if (!color) return "";
  std::string settings =
      fmt::format("{}|{}|{}|{}\n", color->display, color->view, color->look, color->working_space);
  for (const core::AssetRecord& file : loaded.assets->records()) {
    const bool of_color =
        file.reference == color->config ||
        std::find(color->files.begin(), color->files.end(), file.reference) != color->files.end();
    if (of_color) settings += file.sha256 + "\n";
  }
  return settings;
}

}  // namespace

OutputNote::OutputNote(std::string path, const LoadedJob& loaded) : path_(std::move(path)) {
  std::string settings = color_settings(loaded);
  for (const core::OutputDesc& output : loaded.job.outputs) {
    settings +=
        fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}\n", output.file, fmt::join(output.layers, ","),
                    output.tone_map, output.exposure, output.half, output.transparent,
                    output.jpeg_quality, output.denoise, output.bits);
  }
  digest_ = core::to_hex(core::sha256(settings));
}

bool OutputNote::still_true() const {
  std::ifstream file(path_);
  std::string noted;
  return std::getline(file, noted) && noted == digest_;
}

void OutputNote::write() const { (void)core::write_file(path_, std::as_bytes(std::span(digest_))); }

}  // namespace hyades::cli
