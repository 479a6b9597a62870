#include <utility>

#include "core/job/read_sections.h"

namespace hyades::core {

void read_color_config(MapReader& top, Job& job) {
  top.map("color", "color", [&](MapReader& reader) {
    ColorDesc color;
    color.where = reader.where();
    reader.require("config", "a configuration of OpenColorIO such as config.ocio");
    reader.file("config", color.config);
    reader.text("display", color.display, "the name of a display of the configuration");
    reader.text("view", color.view, "the name of a view of the display");
    reader.text("look", color.look, "the name of a look of the configuration");
    reader.text("working_space", color.working_space,
                "the name of a colour space or role of the configuration");
    reader.finish();
    if (!color.config.empty()) job.color = std::move(color);
  });
}

}  // namespace hyades::core
