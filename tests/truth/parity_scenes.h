#pragma once

#include <ostream>
#include <vector>

/// What path tracing, bidirectional path tracing and Metropolis have to agree on. Each scene has
/// something that one of them could get wrong.
namespace hyades::test {

struct ParityScene {
  const char* name;
  const char* text;              ///< without film, sampling, integrator
  int samples = 64;              ///< of each of path's renderings; bdpt takes half
  double relative_error = 0.02;  ///< of the picture's mean that is noticed with 99 % probability
  int max_depth = 6;
  const char* mlt_over = "bdpt";
  const char* filter = "type: box, radius: 0.5";
};

inline void PrintTo(const ParityScene& scene, std::ostream* out) { *out << scene.name; }

/// Surfaces, lights, cameras, textures.
std::vector<ParityScene> solid_parity_scenes();
/// Media.
std::vector<ParityScene> media_parity_scenes();

}  // namespace hyades::test
