#include "cli/command_line.h"
#include "cli/film_commands.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "coordinator/finisher/confine.h"
#include "coordinator/finisher/finish_task.h"
#include "coordinator/finisher/video_task.h"
#include "core/base/assets.h"
#include "core/base/fp_mode.h"
#include "core/base/hash.h"
#include "core/film/film_exr.h"
#include "core/finish/frame_outputs.h"
#include "core/finish/video.h"
#include "core/job/output_path.h"

namespace hyades::cli {
namespace {

/// Tells the coordinator what was written.
core::Status write_result(const std::string& folder, const std::string& outputs,
                          const std::vector<std::string>& paths) {
  std::vector<coordinator::FinishedFile> files;
  for (const std::string& path : paths) {
    const auto bytes = core::map_file(path);
    if (!bytes) return bytes.error().in(path);
    files.push_back({coordinator::told_path(outputs, path), bytes->size(),
                     core::to_hex(core::sha256(bytes->span()))});
  }
  return coordinator::write_finish_result(folder, files);
}

core::Status finish(const std::string& folder) {
  auto task = coordinator::read_finish_task(folder);
  if (!task) return task.error();
  if (auto confined = coordinator::confine_finisher(folder, task->folder); !confined) {
    return confined;
  }
  auto film = coordinator::read_finish_film(folder);
  if (!film) return film.error();
  std::shared_ptr<const core::DisplayTransform> display;
  if (task->color) {
    auto opened = core::open_display_transform(task->color->config, *task->color);
    if (!opened) return opened.error();
    display = std::move(*opened);
  }
  auto paths = core::write_outputs(task->outputs, task->folder, task->info, *film, display.get());
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
  return write_result(folder, task->folder, *paths);
}

volatile std::sig_atomic_t g_asked_to_end = 0;

core::Status make_video(const std::string& folder) {
  const auto task = coordinator::read_video_task(folder);
  if (!task) return task.error();
  core::VideoPatience patience;
  patience.starter = {"/proc/self/exe", "encode", task->frames.folder};
  patience.stop = [parent = ::getppid()] { return g_asked_to_end != 0 || ::getppid() != parent; };
  auto made = core::make_video(task->video, task->frames, patience);
  if (!made) return made;
  return write_result(folder, task->frames.folder, {task->frames.folder + "/" + task->video.file});
}

}  // namespace

int finish_command(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: hyades-film finish FOLDER (coordinators use it)\n");
    return 2;
  }
  const core::FpMode mode;
  if (const core::Status done = finish(argv[1]); !done) {
    print_error(done.error());
    return 1;
  }
  return 0;
}

int encode_command(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: hyades-film encode FOLDER PROGRAM ARGUMENTS... (it uses it)\n");
    return 2;
  }
  if (auto confined = coordinator::confine_encoder(argv[2], argv[1]); !confined) {
    std::fprintf(stderr, "it cannot be held in: %s\n", confined.error().message.c_str());
    return 1;
  }
  ::execv(argv[2], argv + 2);
  std::fprintf(stderr, "%s: %s\n", argv[2], std::strerror(errno));
  return 1;
}

int finish_video_command(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: hyades-film video FOLDER (coordinators use it)\n");
    return 2;
  }
  std::signal(SIGTERM, [](int) { g_asked_to_end = 1; });
  if (const core::Status done = make_video(argv[1]); !done) {
    print_error(done.error());
    return 1;
  }
  return 0;
}

}  // namespace hyades::cli
