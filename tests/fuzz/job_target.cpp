// The YAML of a job, as somebody gives it to a coordinator: what is read is written in full and
// hashed, too, as that follows.

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  std::vector<std::string> all;
  for (const char* name :
       {"quickstart", "cornell", "perlin-sphere", "god-rays", "materials", "depth-of-field"}) {
    std::string text = source_file("jobs/" + std::string(name) + "/job.yaml");
    if (!text.empty()) all.push_back(std::move(text));
  }
  all.emplace_back(
      "hyades: 1\nframes: {range: 1-9, fps: 24}\nfilm: {size: [8, 6]}\n"
      "camera: {look_from: [0, \"= sin(t)\", 6], look_at: {keys: {1: [0, 1, 0], 9: [1, 1, 0]}}}\n"
      "textures: {a: &x {type: checker, a: 0.1}, b: {like: a, scale: 3}}\n"
      "materials: {m: {type: glossy, color: a}}\n"
      "objects: {o: {shape: sphere, material: m, at: [0, 0, 0]}}\n");
  return all;
}

bool try_input(std::string_view input) {
  Files files("job.yaml", input);
  files.add_all_others("ply\n");
  core::Diagnostics diagnostics;
  const core::Job job = core::parse_job(std::string(input), "job.yaml", files, diagnostics);
  if (!diagnostics.empty()) return false;
  return !core::render_key(job, job.frames.first, {}).empty();
}

}  // namespace hyades::fuzz
