#include "cli/finish_command.h"

#include <cstdio>
#include <filesystem>

#include "coordinator/finisher/finish_task.h"
#include "core/base/assets.h"
#include "core/base/fp_mode.h"
#include "core/base/hash.h"
#include "core/film/film_exr.h"
#include "core/finish/frame_outputs.h"
#include "core/job/output_path.h"

namespace hyades::cli {
namespace {

core::Status finish(const std::string& folder) {
  auto task = coordinator::read_finish_task(folder);
  if (!task) return task.error();
  auto film = coordinator::read_finish_film(folder);
  if (!film) return film.error();
  auto paths = core::write_outputs(task->outputs, task->folder, task->info, *film);
  if (!paths) return paths.error();
  if (!task->film.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(task->folder, failed);
    if (failed) return core::Error{task->folder + ": cannot be made: " + failed.message()};
    paths->push_back(task->folder + "/" + core::output_path(task->film, task->info.frame));
    const core::Status written =
        core::write_film_exr(paths->back(), {task->info, std::move(*film)});
    if (!written) return written;
  }
  std::vector<coordinator::FinishedFile> files;
  for (const std::string& path : *paths) {
    const auto bytes = core::map_file(path);
    if (!bytes) return bytes.error().in(path);
    files.push_back({std::filesystem::path(path).lexically_relative(task->folder).string(),
                     bytes->size(), core::to_hex(core::sha256(bytes->span()))});
  }
  return coordinator::write_finish_result(folder, files);
}

}  // namespace

int finish_command(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: hyades-film finish FOLDER (coordinators use it)\n");
    return 2;
  }
  const core::FpMode mode;
  if (const core::Status done = finish(argv[1]); !done) {
    std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return 1;
  }
  return 0;
}

}  // namespace hyades::cli
