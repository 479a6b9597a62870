#include "import/pbrt/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/pbrt/motion.h"
#include "import/pbrt/read_parameters.h"
#include "import/pbrt/render_sections.h"

namespace hyades::core::pbrt {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// The focal length, mm, of a file of lens elements from front to back: rows of radius [mm], way to
/// the next [mm], index behind and diameter [mm]; radius 0 is the stop. By rays near the axis.
/// Errors: no such rows, or a lens that does not gather light.
Result<double> focal_length(std::string_view lens_file) {
  Tokenizer tokens(lens_file, {});
  std::vector<double> numbers;
  for (Token token = tokens.next(); token.kind != Token::Kind::end; token = tokens.next()) {
    const auto number = token.kind == Token::Kind::word ? number_of(token.text) : std::nullopt;
    if (!number) return Error{"the lens file holds something other than numbers"};
    numbers.push_back(*number);
  }
  if (numbers.empty() || numbers.size() % 4 != 0) {
    return Error{"the lens file has not four numbers for each element"};
  }
  // A ray parallel to the axis, one away from it.
  double height = 1.0;
  double slope = 0.0;
  double index = 1.0;
  for (size_t i = 0; i < numbers.size(); i += 4) {
    const double radius = numbers[i];
    if (radius != 0.0) {
      const double behind = numbers[i + 2] > 0.0 ? numbers[i + 2] : 1.0;
      slope = (index * slope - height * (behind - index) / radius) / behind;
      index = behind;
    }
    height += slope * numbers[i + 1];
  }
  if (!(slope < 0.0)) return Error{"the lens does not gather light"};
  return -1.0 / slope;
}

/// What of the plane at distance 1 the film shows (perspective), or of the camera's plane.
struct Window {
  double left, right, bottom, top;
  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

/// By default the shorter side goes from -1 to 1.
Window window_of(ParameterReader& camera, const FilmSize& size) {
  const double film = static_cast<double>(size.width) / static_cast<double>(size.height);
  const auto aspect =
      static_cast<double>(camera.number("frameaspectratio", static_cast<float>(film)));
  Window window = aspect > 1.0 ? Window{-aspect, aspect, -1.0, 1.0}
                               : Window{-1.0, 1.0, -1.0 / aspect, 1.0 / aspect};
  const auto numbers = camera.numbers("float", "screenwindow");
  if (numbers.size() == 4) {
    window = {numbers[0], numbers[1], numbers[2], numbers[3]};
  } else if (!numbers.empty()) {
    camera.report().error(camera.place(), "screenwindow has 4 values: x0 x1 y0 y1");
  }
  if (!(window.width() > 0.0 && window.height() > 0.0)) {
    camera.report().error(camera.place(), "the screen window is empty");
    return {-film, film, -1.0, 1.0};
  }
  if (std::abs(window.width() / window.height() / film - 1.0) > 0.01) {
    camera.report().note(camera.place(),
                         "the screen window has another shape than the film: pixels are square "
                         "here, and its height counts");
  }
  return window;
}

/// A thin lens of the same focal length stands in for the elements of a real one; its field of view
/// along the shorter side of a film of this diagonal, which is at the focus of what is far.
/// Nothing, and an error of the report, where the lens cannot be read.
std::optional<double> realistic_fov(Context& context, ParameterReader& camera,
                                    const Window& window) {
  const std::string file = camera.text("lensfile");
  camera.text("aperture");
  const auto bytes = context.loaded.files.find(file);
  if (bytes == context.loaded.files.end()) {
    const auto why = context.loaded.missing.find(file);
    context.report.error(camera.place(), why == context.loaded.missing.end()
                                             ? "a realistic camera needs a lensfile"
                                             : why->second);
    return std::nullopt;
  }
  const auto length = focal_length({bytes->second.chars(), bytes->second.size()});
  if (!length) {
    context.report.error(camera.place(), file + ": " + length.error().message);
    return std::nullopt;
  }
  context.report.note(camera.place(), "a thin lens stands in for the elements of '" + file + "'");
  ParameterReader film = read(context, context.scene.film);
  const auto diagonal = static_cast<double>(film.number("diagonal", 35.0F));
  // The window goes from -1 to 1 along the shorter side.
  const double half = diagonal / std::hypot(window.width(), window.height());
  return 2.0 * std::atan(half / *length) * kDegrees;
}

/// Where the camera is at a moment of the shutter.
struct Pose {
  Vec3d from, at, up, right;
};

Pose pose_at(Context& context, double u, const Vec3d& forward) {
  const Mat4d m = context.to_job * at_shutter(context, context.scene.camera.to_world, u);
  const glm::dmat3 linear(m);
  Pose pose;
  pose.from = Vec3d(m[3]);
  // Far enough for numbers of 32 bits to tell the two points apart.
  const double distance = std::max(1.0, glm::length(pose.from));
  pose.at = pose.from + distance * glm::normalize(linear * forward);
  pose.up = glm::normalize(linear[1]);
  pose.right = linear[0];
  return pose;
}

void put_vector(YamlMap& node, const char* key, const std::array<Vec3d, 2>& values, bool moves) {
  YamlPtr open = yaml_vector(Vec3(values[0]));
  if (!moves || values[0] == values[1]) {
    node.put(key, open);
    return;
  }
  node.put(key,
           YamlMap{{"keys", YamlMap{{"1", open}, {"2", yaml_vector(Vec3(values[1]))}}.node()}});
}

}  // namespace

FilmSize film_size(Context& context) {
  ParameterReader film(context.scene.film.parameters, context.scene.film.place, context.report);
  return {film.integer("xresolution", 1280), film.integer("yresolution", 720)};
}

void add_camera(Context& context, YamlMap& out) {
  const PlacedEntity& entity = context.scene.camera;
  ParameterReader camera(entity.parameters, entity.place, context.report);
  const FilmSize size = film_size(context);
  if (size.width < 1 || size.height < 1) return;
  camera.number("shutteropen", 0.0F);
  camera.number("shutterclose", 1.0F);

  YamlMap node;
  const bool around = entity.type == "spherical";
  const bool flat = entity.type == "orthographic";
  Vec3d forward(0.0, 0.0, 1.0);
  Vec2 middle(0.0F);  // of the window, in the camera's space
  const double stretch = glm::length(Vec3d(at_shutter(context, entity.to_world, 0.0)[2]));
  float lens = camera.number("lensradius", 0.0F);
  float focus = camera.number("focaldistance", 1e6F);
  if (around) {
    node.put("type", yaml_word("equirectangular"));
    forward = Vec3d(-1.0, 0.0, 0.0);
    if (camera.text("mapping", "equalarea") != "equirectangular") {
      context.report.note(entity.place, "the equal-area panorama becomes an equirectangular one");
    }
    camera.number_if("frameaspectratio");
    camera.numbers("float", "screenwindow");
  } else {
    const Window window = window_of(camera, size);
    if (flat) {
      node.put("type", yaml_word("orthographic"));
      node.put("height", yaml_number(static_cast<float>(window.height() * stretch)));
      middle = Vec2((window.left + window.right) / 2.0, (window.bottom + window.top) / 2.0);
    } else {
      auto fov = static_cast<double>(camera.number("fov", 90.0F));
      if (entity.type == "realistic") {
        const auto found = realistic_fov(context, camera, window);
        if (!found) return;
        fov = *found;
        lens = camera.number("aperturediameter", 1.0F) / 2000.0F;  // millimetres
        focus = camera.number("focusdistance", 10.0F);
      } else if (entity.type != "perspective") {
        context.report.error(entity.place, "there is no camera '" + entity.type + "'");
        return;
      }
      if (!(fov > 0.0 && fov < 180.0)) {
        context.report.error(entity.place, "fov is not between 0 and 180 degrees");
        return;
      }
      const double half = std::tan(0.5 * fov / kDegrees) * window.height() / 2.0;
      node.put("fov", yaml_number(static_cast<float>(2.0 * std::atan(half) * kDegrees)));
      const std::array<float, 2> shift{
          static_cast<float>((window.left + window.right) / 2.0 / window.width()),
          static_cast<float>((window.bottom + window.top) / 2.0 / window.height())};
      if (shift != std::array<float, 2>{}) node.put("shift", yaml_numbers(shift));
    }
    if (lens > 0.0F && focus > 0.0F) {
      node.put("aperture", YamlMap{{"radius", yaml_number(lens * static_cast<float>(stretch))}});
      node.put("focus", yaml_number(focus * static_cast<float>(stretch)));
    }
  }
  const bool moves = entity.to_world.moves();
  std::array<Vec3d, 2> from, at, up;
  for (size_t i = 0; i < 2; ++i) {
    Pose pose = pose_at(context, static_cast<double>(i), forward);
    const Mat4d m = context.to_job * at_shutter(context, entity.to_world, static_cast<double>(i));
    const Vec3d aside = glm::dmat3(m) * Vec3d(middle.x, middle.y, 0.0);
    from[i] = pose.from + aside;
    at[i] = pose.at + aside;
    up[i] = pose.up;
  }
  put_vector(node, "look_from", from, moves);
  put_vector(node, "look_at", at, moves);
  put_vector(node, "up", up, moves);
  camera.note_unused();
  out.put("camera", node);
}

}  // namespace hyades::core::pbrt
