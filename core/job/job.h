#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/rect.h"
#include "core/job/animated.h"
#include "core/job/density_desc.h"
#include "core/job/source.h"
#include "core/job/value_checks.h"

/// A job as plain structs: what the YAML says, validated, with defaults filled in and names still
/// names. The in-class defaults are the documented ones (docs/job.md). Lengths are in metres after
/// `units` has been applied by the scene builder; angles in degrees.
namespace hyades::core {

/// A colour that is a value or comes from a named texture.
struct ColorInput {
  Animated<Rgb> value{Rgb(1.0F)};
  std::string texture;  ///< name in Job::textures; empty = use value
};

/// A number that is a value or comes from a named texture (its scalar).
struct ScalarInput {
  Animated<float> value{0.0F};
  std::string texture;
};

struct FramesDesc {
  int32_t first = 1;
  int32_t last = 1;
  int32_t step = 1;
  float fps = 24.0F;
  float shutter = 0.0F;  ///< fraction of the frame time that the shutter stays open, 0..1
};

enum class FilterKind { box, triangle, gaussian, mitchell, blackman_harris, center };

struct FilmDesc {
  int32_t width = 640;
  int32_t height = 360;
  std::optional<PixelRect> crop;  ///< pixels to render; all where absent
  FilterKind filter = FilterKind::blackman_harris;
  float filter_radius = 1.5F;  ///< pixels; half the filter's width
};

/// The part of the frame that a job renders: its crop, or everything.
inline PixelRect render_window(const FilmDesc& film) {
  const PixelRect frame{0, 0, film.width, film.height};
  return film.crop ? intersection(frame, *film.crop) : frame;
}

enum class SamplerName { sobol, independent };

struct SamplingDesc {
  uint32_t samples = 64;  ///< per pixel
  uint64_t seed = 0;
  SamplerName sampler = SamplerName::sobol;
};

struct IntegratorDesc {
  std::string type = "path";
  int max_depth = 32;      ///< most scattering events between light and camera
  int roulette_depth = 4;  ///< Russian roulette may end a path after this many
  float clamp = 0.0F;      ///< path; biased: largest radiance of one indirect sample; 0 = off

  // bdpt: to look at one strategy alone.
  int light_vertices = -1;   ///< s: only paths of which the light path gives so many; -1: all
  int camera_vertices = -1;  ///< t, likewise
  bool mis = true;           ///< false: unweighted

  // mlt.
  std::string over = "bdpt";  ///< path | bdpt: whose samples the chains mutate
  float large_step = 0.3F;    ///< probability of an independent sample, (0, 1]

  // Not keys of jobs: fewer, or more, scattering events bring no light.
  int min_events = 0;
  int max_events = 1 << 30;
};

struct CameraDesc {
  std::string type = "perspective";
  Animated<Vec3> look_from{Vec3(0.0F, 1.0F, 5.0F)};
  Animated<Vec3> look_at{Vec3(0.0F)};
  Animated<Vec3> up{Vec3(0.0F, 1.0F, 0.0F)};
  Animated<float> fov{40.0F};             ///< vertical, degrees, (0, 180)
  Animated<float> aperture_radius{0.0F};  ///< length; 0 = pinhole
  std::optional<Animated<float>>
      f_stop;                      ///< radius = focal length / (2 f_stop), on a 24 mm high sensor
  int aperture_blades = 0;         ///< 0 = round, else >= 3
  float aperture_rotation = 0.0F;  ///< degrees
  std::optional<Animated<float>> focus_distance;  ///< along the view axis; absent: to look_at
  std::string focus_object;                       ///< focus on this object's centre
  SourceLocation focus_where;                     ///< of its name
};

struct TextureDesc {
  std::string name;
  SourceLocation where;
  std::string type;  ///< constant | image | checker | scale | perlin3d | perlin4d | fbm3d | fbm4d
  ColorInput a{};    ///< checker, noise: first colour; constant: its value; scale: input
  ColorInput b{};    ///< checker, noise: second colour; scale: factor
  // image
  std::string file;
  std::string color_space = "auto";  ///< auto | srgb | linear
  std::string wrap = "repeat";       ///< repeat | clamp | mirror | black
  std::string filter = "bilinear";   ///< bilinear | nearest
  // checker, noise
  Animated<Vec3> scale{Vec3(1.0F)};  ///< cells (or repeats of the image) per unit of the mapping
  Animated<Vec3> offset{Vec3(0.0F)};
  std::string mapping = "default";  ///< default | uv | object | world
  int octaves = 1;
  float lacunarity = 2.0F;
  float gain = 0.5F;
  Animated<float> time{0.0F};  ///< fourth coordinate of perlin4d and fbm4d
};

struct BumpDesc {
  std::string texture;
  Animated<float> height{0.01F};  ///< length that the texture's value 1 stands for
};

/// What fills bodies of a material, said as one sees it; core/media/albedo_inversion.h makes
/// coefficients of it.
struct SubsurfaceDesc {
  Animated<Rgb> color{Rgb(0.8F)};   ///< share of the light that comes back out of a thick body
  Animated<Rgb> radius{Rgb(1.0F)};  ///< how far light goes until it has lost its direction [length]
  Animated<float> scale{1.0F};      ///< multiplies radius
  Animated<float> g{0.0F};          ///< mean cosine, (-1, 1)
};

struct MaterialDesc {
  std::string name;
  SourceLocation where;
  std::string type;  ///< lambert | dielectric | thin-dielectric | conductor | glossy | mirror | mix
                     ///< | null | black
  ColorInput color{Animated<Rgb>(Rgb(0.5F)), {}};
  std::string metal = "gold";  ///< conductor: a name of the table, or "custom" with eta and k
  std::optional<Animated<Rgb>> eta, k;               ///< conductor: measured index
  ScalarInput roughness{Animated<float>(0.0F), {}};  ///< perceptual, alpha = roughness^2
  Animated<float> ior{1.5F};
  Animated<Rgb> transmission{Rgb(1.0F)};                  ///< dielectric: tint per crossing
  Animated<Rgb> reflection{Rgb(1.0F)};                    ///< dielectric, conductor, mirror: tint
  ScalarInput reflectiveness{Animated<float>(0.5F), {}};  ///< glossy: 0 = Lambert, 1 = lobe only
  ScalarInput glossiness{Animated<float>(0.8F), {}};      ///< glossy: sharpness of the lobe, 0..1
  /// Give back what facets shadow. Dielectrics and conductors do unless told not to, glossy
  /// surfaces only if told to.
  bool multiple_scattering = false;
  std::string first, second;                      ///< mix: material names
  ScalarInput amount{Animated<float>(0.5F), {}};  ///< mix: share of `second`
  std::optional<BumpDesc> bump;
  std::optional<SubsurfaceDesc> subsurface;  ///< dielectric, null: of bodies without an interior
};

/// What fills space. Coefficients are per unit of length; they are given as they are, or by an
/// albedo with a mean free path or an extinction coefficient.
struct MediumDesc {
  std::string name;
  SourceLocation where;
  Animated<Rgb> absorption{Rgb(0.0F)};          ///< 1/length
  Animated<Rgb> scattering{Rgb(0.0F)};          ///< 1/length
  std::optional<Animated<Rgb>> albedo;          ///< scattering / (absorption + scattering)
  std::optional<Animated<Rgb>> mean_free_path;  ///< length
  std::optional<Animated<Rgb>> density;         ///< absorption + scattering, 1/length
  std::string phase = "henyey-greenstein";      ///< henyey-greenstein | rayleigh
  Animated<Rgb> g{Rgb(0.0F)};                   ///< mean cosine, (-1, 1)
  Animated<Rgb> g2{Rgb(0.0F)};                  ///< of a second lobe
  Animated<float> blend{0.0F};                  ///< share of the second lobe
  Animated<Rgb> emission{Rgb(0.0F)};            ///< W/(length^3 sr)
  Animated<float> scale{1.0F};                  ///< multiplies all coefficients
  Animated<float> emission_strength{1.0F};      ///< multiplies emission
  std::optional<DensityDesc> varying;           ///< multiplies them from place to place in a body
  std::optional<GlowDesc> glow;                 ///< where emission varies in its own way
  std::optional<float> index;  ///< of refraction, of bodies of it that have no material
};

/// Light that a shape gives off.
struct EmitDesc {
  Animated<Rgb> color{Rgb(1.0F)};
  enum class Unit { radiance, power } unit = Unit::radiance;
  Animated<float> amount{1.0F};  ///< W/(m^2 sr), or W over the whole shape; multiplied with color
  bool two_sided = false;        ///< open shapes: give light from the back too
};

struct ObjectDesc {
  std::string name;
  SourceLocation where;
  std::string shape;  ///< mesh | sphere | rectangle | disk | box | cylinder | instance | group
  std::string mesh;   ///< file
  std::string part;   ///< mesh: the material of the file whose triangles are meant; empty: all
  std::string instance_of;           ///< name in Job::groups
  std::vector<ObjectDesc> children;  ///< group written in place
  float radius = 1.0F;
  Vec3 size{1.0F};              ///< rectangle: x, z extent; box: all three
  float height = 1.0F;          ///< cylinder, along y
  bool caps = true;             ///< cylinder
  std::string smooth = "file";  ///< mesh normals: file | flat | smooth
  std::string material;         ///< empty: inherited from the group, else of the medium's index
                                ///< of refraction, else grey lambert
  std::string interior;         ///< name in Job::media of what fills it; empty: nothing
  std::string exterior;         ///< name in Job::media of what is around it; empty: not said
  int32_t priority = 0;         ///< where bodies overlap, the highest says what is there
  TransformList transform;
  Animated<Vec3> at{Vec3(0.0F)};  ///< translation after `transform`
  std::optional<EmitDesc> emit;
  bool visible_to_camera = true;
};

struct GroupDesc {
  std::string name;
  SourceLocation where;
  std::vector<ObjectDesc> objects;
};

struct LightDesc {
  std::string name;
  SourceLocation where;
  std::string type;                                   ///< point | spot | sun
  Animated<Vec3> at{Vec3(0.0F)};                      ///< point, spot
  Animated<Vec3> look_at{Vec3(0.0F, -1.0F, 0.0F)};    ///< spot
  Animated<Vec3> direction{Vec3(0.0F, -1.0F, 0.0F)};  ///< sun: the way its light travels
  Animated<Rgb> color{Rgb(1.0F)};
  Animated<float> power{10.0F};      ///< point, spot: W (spot: as if it shone all round)
  Animated<float> irradiance{1.0F};  ///< sun: W/m^2 on a surface facing it
  Animated<float> angle{0.53F};      ///< sun: diameter, degrees; spot: half angle of the cone
  Animated<float> blend{0.2F};       ///< spot: share of the cone that fades, 0..1
};

struct EnvironmentDesc {
  SourceLocation where;
  std::string image;               ///< lat-long map; empty = constant colour
  Animated<Rgb> color{Rgb(1.0F)};  ///< constant colour, or a tint of the image
  Animated<float> rotate_y{0.0F};  ///< degrees
  Animated<float> strength{1.0F};
  bool visible_to_camera = true;
};

struct OutputDesc {
  SourceLocation where;
  std::string file;                 ///< #### stands for the frame number
  std::vector<std::string> layers;  ///< beauty alpha depth albedo normal variance samples; EXR only
  std::string tone_map = "srgb";    ///< srgb | filmic | aces | linear; PNG and JPEG
  float exposure = 0.0F;            ///< stops
  bool half = false;                ///< EXR: 16 bits
  bool transparent = false;         ///< PNG: alpha channel
};

struct Job {
  std::string file;                   ///< path of the YAML; relative references start at its folder
  std::vector<std::string> includes;  ///< files of `include:` and of media, relative to its folder
  std::string name;
  float units = 1.0F;  ///< metres per unit of length in the job
  FramesDesc frames;
  FilmDesc film;
  SamplingDesc sampling;
  IntegratorDesc integrator;
  CameraDesc camera;
  std::vector<TextureDesc> textures;
  std::vector<MaterialDesc> materials;
  std::vector<MediumDesc> media;
  std::vector<GroupDesc> groups;
  std::vector<ObjectDesc> objects;
  std::vector<LightDesc> lights;
  std::optional<EnvironmentDesc> environment;
  std::string atmosphere;  ///< name in Job::media of what fills all space; empty: nothing
  std::vector<OutputDesc> outputs;
  bool keep_films = false;  ///< each finished frame's film stays, as film_file() says
  ValueChecks checks;       ///< what its animated values must keep to at every frame (check_frame)

  /// The moment at which frame `frame`'s shutter is open for fraction `shutter_time` (0..1).
  JobTime time_of(int32_t frame, float shutter_time = 0.0F) const {
    const double at = frame + double{shutter_time} * double{frames.shutter};
    return {(at - 1.0) / double{frames.fps}, at};
  }
};

}  // namespace hyades::core
