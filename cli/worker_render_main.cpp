// hyades-worker-render: the child of a worker that renders. It knows light and no network: units
// come and films go through the socket it is born with, files come out of the worker's cache.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/number_range.h"
#include "core/base/descriptor.h"
#include "core/base/machine.h"
#include "core/base/parallel.h"
#include "core/base/process_limits.h"
#include "core/base/version.h"
#include "core/render/class_probe.h"
#include "core/textures/texel_store.h"
#include "farm/content_store.h"
#include "farm/wire.h"
#include "worker/pipe/message_pipe.h"
#include "worker/pipe/render_pipe.pb.h"
#include "worker/render/render_server.h"
#include "worker/render/sandbox.h"
#include "worker/render/scene_shelf.h"

namespace {

using namespace hyades;

/// Where the worker leaves its end of the pipe.
constexpr int kPipe = 3;
/// Where the file for texels is; what comes after is closed.
constexpr int kTexels = 4;
/// The most bytes of a message from the worker: a job's specification, and what goes with it.
constexpr uint32_t kMostSaid = farm::kMaxMessageBytes + (uint32_t{64} << 10U);
/// What libraries take besides scenes, and what each thread's stack may.
constexpr uint64_t kOverhead = uint64_t{256} << 20U;
constexpr uint64_t kThreadOverhead = uint64_t{8} << 20U;
/// Bytes up to which the worker's log, where that is a file, takes lines of this process in any
/// case.
constexpr uint64_t kLogBytes = uint64_t{64} << 20U;

int refuse(pipe::MessagePipe& parent, const std::string& reason) {
  pipe::FromRenderer message;
  message.mutable_not_ready()->set_reason(farm::wire_text(reason));
  (void)parent.send(message);
  return 1;
}

/// A file without a name at kTexels, in TMPDIR or beside the cache's files (/tmp may be in memory);
/// none where none can be made.
core::Descriptor open_texel_file(const std::string& cache) {
  const char* temporary = std::getenv("TMPDIR");
  for (const std::string& folder : {std::string(temporary == nullptr ? "" : temporary), cache}) {
    if (folder.empty()) continue;
    auto file = core::TexelStore::open_file(folder);
    if (!file) continue;
    if (file->get() == kTexels) return std::move(*file);
    return core::Descriptor(::dup3(file->get(), kTexels, O_CLOEXEC));
  }
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Renders for a worker, which starts it.", "hyades-worker-render");
  int threads = 1;
  uint64_t memory = 0;
  uint64_t texture_disk = 0;
  std::string cache;
  app.add_option("--threads", threads)->check(hyades::cli::in_range(1, 4096));
  app.add_option("--memory", memory);
  app.add_option("--texture-disk", texture_disk);
  std::string sandbox = "auto";
  app.add_option("--cache", cache)->required();
  app.add_option("--sandbox", sandbox);
  CLI11_PARSE(app, argc, argv);
  // The worker decides when this process ends: a Ctrl-C reaches both.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  core::ignore_file_size_signal();
  pipe::MessagePipe parent(kPipe, {kMostSaid, 0});
  const auto mode = worker::read_sandbox_mode(sandbox);
  if (!mode) return refuse(parent, mode.error().message);
  // What has to be opened or written, before nothing can be.
  core::Descriptor texels = open_texel_file(cache);
  const core::Status goes_first = core::go_first();
  const auto lacking = worker::enter_sandbox(*mode, cache, texels.valid() ? kTexels + 1 : kTexels);
  if (!lacking) return refuse(parent, lacking.error().message);
  // Scenes are built by as many threads as the machine has.
  const auto all_threads = static_cast<uint64_t>(threads + core::hardware_threads());
  const core::Status limited =
      core::limit_memory(memory == 0 ? 0 : memory + kOverhead + all_threads * kThreadOverhead);
  if (!limited) return refuse(parent, limited.error().message);
  texture_disk = std::min(texture_disk, core::TexelStore::half_of_free(texels));
  const core::Status bounded = core::limit_file_size(std::max(texture_disk, kLogBytes));
  if (!bounded) return refuse(parent, bounded.error().message);

  const auto native = core::this_class(core::RenderClass::native);
  if (!native) return refuse(parent, native.error().message);
  const auto portable = core::this_class(core::RenderClass::portable);
  if (!portable) return refuse(parent, portable.error().message);
  auto store = farm::ContentStore::open({cache, 0});
  if (!store) return refuse(parent, store.error().message);
  pipe::FromRenderer ready;
  ready.mutable_ready()->set_worker_class(*native);
  ready.mutable_ready()->set_portable_class(*portable);
  ready.mutable_ready()->set_build(fmt::format("hyades {}, renderer {}, build {}", core::kVersion,
                                               core::kRendererRevision,
                                               core::build_id().substr(0, 12)));
  ready.mutable_ready()->set_sandbox_lacks(farm::wire_text(*lacking));
  if (!goes_first) ready.mutable_ready()->set_not_first(goes_first.error().message);
  if (!parent.send(ready)) return 1;

  worker::SceneShelf shelf(**store, memory, {std::move(texels), texture_disk});
  worker::RenderServer server(parent, shelf, threads);
  server.run();
  ::_exit(0);  // threads may be in the midst of units that nobody waits for
}
