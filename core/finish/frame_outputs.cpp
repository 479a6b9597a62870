#include "core/finish/frame_outputs.h"

#include "core/finish/picture.h"

namespace hyades::core {

Result<std::vector<std::string>> write_outputs(std::span<const OutputDesc> outputs,
                                               const std::string& folder, const FilmInfo& info,
                                               const Film& film) {
  const ImageMetadata metadata = {
      {"hyades.job", info.job_name},
      {"hyades.frame", std::to_string(info.frame)},
      {"hyades.samples", std::to_string(info.samples)},
      {"hyades.renderKey", info.render_key},
      {"hyades.class", info.worker_class},
      {"hyades.build", info.build},
  };
  Image picture = film.normalised();
  const PixelRect& window = film.window();
  if (window != PixelRect{0, 0, info.width, info.height}) {
    picture.placement = {window.x0, window.y0, info.width, info.height};
  }
  std::vector<std::string> paths;
  for (const OutputDesc& output : outputs) {
    paths.push_back(output_path(output, folder, info.frame));
    if (auto written = write_output(output, picture, paths.back(), metadata); !written) {
      return written.error();
    }
  }
  return paths;
}

}  // namespace hyades::core
