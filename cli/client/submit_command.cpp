#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/blend_job.h"
#include "cli/client/client_app.h"
#include "cli/client/show.h"
#include "cli/client/upload.h"
#include "cli/client/watch.h"
#include "cli/client_commands.h"
#include "cli/command_line.h"
#include "cli/frame_range.h"
#include "cli/number_range.h"
#include "cli/scene_options.h"
#include "core/base/folder_links.h"
#include "core/base/printable.h"
#include "core/base/random_id.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"
#include "farm/job_package.h"
#include "farm/tags.h"
#include "farm/token_term.h"
#include "farm/wire.h"

namespace hyades::cli {

using core::Result;

namespace {

constexpr int kMostUploads = 3;  // rounds of bringing what the coordinator misses

struct SubmitOptions {
  std::string path;
  std::string frames;
  std::string owner;
  std::string name;
  SceneOptions scene;
  uint32_t samples = 0;
  int32_t priority = 0;
  uint32_t max_workers = 0;
  std::vector<std::string> tags;
  uint64_t memory = 0;
  uint32_t attempts = 3;
  uint32_t redundancy = 0;
  std::string order = "sequential";
  bool watch = false;
  bool quiet = false;
  bool json = false;
};

void declare_submit(CLI::App& app, SubmitOptions& options) {
  app.add_option("job", options.path, job_words())->required();
  app.add_flag("--watch", options.watch, "stay and show progress until the job has ended");
  app.add_option("--priority", options.priority, "higher goes first")
      ->check(in_range(-1'000'000, 1'000'000))
      ->capture_default_str();
  app.add_option("--owner", options.owner,
                 "whose job it is; owners share the farm (default: the token's name, or you)");
  app.add_option("--name", options.name, "what the job is called (default: its document's name)");
  app.add_option("--frames", options.frames, "frames to render: 7, 1-10 or 1-10x2 (default: all)")
      ->check(no_frames_error);
  app.add_option("--samples", options.samples, "samples per pixel (default: the job's)")
      ->check(in_range(1U, 1U << 24U));
  declare_scene_options(app, options.scene);
  app.add_option("--max-workers", options.max_workers, "render on no more than so many at once");
  app.add_option("--tags", options.tags, "render only on workers that have all of these: a,b")
      ->delimiter(',')
      ->allow_extra_args(false);  // what follows is the job
  app.add_option("--memory", options.memory,
                 "render only on workers that have so much for scenes: 8G, 512M")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--attempts", options.attempts,
                 "a unit that fails on so many different workers stops its frame (where fewer are "
                 "there: on all of them, and so often in all)")
      ->check(in_range(1U, 100U))
      ->capture_default_str();
  app.add_option("--redundancy", options.redundancy,
                 "percent of the units to be rendered twice, by workers of different tokens or "
                 "machines, and compared")
      ->check(in_range(0U, 100U))
      ->capture_default_str();
  app.add_option("--order", options.order,
                 "sequential: frame after frame (default); progressive: a few samples of every "
                 "frame first, then more")
      ->check(CLI::IsMember({"sequential", "progressive"}));
  app.add_flag("-q,--quiet", options.quiet, "show no progress");
  app.add_flag("--json", options.json,
               "print the job as JSON (field id); with --watch as it is at the end");
  app.footer(
      "examples:\n  hyades submit jobs/perlin-sphere/job.yaml --watch && hyades fetch "
      "perlin-sphere "
      "--output out\n  hyades submit shot.yaml --frames 1-24 --priority 10 --tags fast\n"
      "  hyades submit shot.yaml --name shot-take-2\n"
      "exit status: 0 taken in (with --watch: the job is done), 1 failed, 2 the job or the "
      "arguments are\n"
      "wrong, 3 no coordinator answers; others: docs/client.md");
}

std::string user_name() {
  if (const char* user = std::getenv("USER"); user != nullptr && *user != '\0') return user;
  const passwd* entry = ::getpwuid(::getuid());
  return entry != nullptr ? entry->pw_name : fmt::format("user-{}", ::getuid());
}

Result<v1::SubmitRequest> make_request(const farm::JobPackage& package,
                                       const SubmitOptions& options) {
  v1::SubmitRequest request;
  v1::JobSpec& spec = *request.mutable_spec();
  spec.set_name(options.name.empty() ? package.job.name : options.name);
  spec.set_document(package.document);
  spec.set_samples(options.samples);
  for (const core::AssetRecord& asset : package.files) {
    const auto digest = farm::digest_from_hex(asset.sha256);
    if (!digest) return digest.error();
    v1::JobFile& file = *spec.add_files();
    file.set_path(asset.reference);
    file.set_sha256(farm::to_wire(*digest));
    file.set_size(asset.size);
  }
  const auto range = parse_frames(package.job.frames, options.frames);
  if (!range) return range.error();
  if (!options.frames.empty()) {
    v1::FrameRange& frames = *spec.add_frames();
    frames.set_first(range->first);
    frames.set_last(range->last);
    frames.set_step(range->step);
  }
  request.set_owner(options.owner);
  request.set_login(user_name());
  request.set_priority(options.priority);
  request.set_max_workers(options.max_workers);
  const auto tags = farm::check_tags(options.tags);
  if (!tags) return tags.error();
  for (const std::string& tag : *tags) request.add_tags(tag);
  request.set_memory_bytes(options.memory);
  request.set_max_attempts(options.attempts);
  request.set_redundancy(options.redundancy);
  request.set_frame_order(options.order == "progressive" ? v1::FRAME_ORDER_PROGRESSIVE
                                                         : v1::FRAME_ORDER_SEQUENTIAL);
  const auto key = core::random_id();
  if (!key) return key.error();
  request.set_idempotency_key(*key);
  return request;
}

/// Several lines: every complaint about the job, with its path as it can be shown.
Outcome submit(FarmClient& client, const farm::JobPackage& package, core::JobFiles& files,
               const v1::SubmitRequest& request, bool quiet, v1::SubmitResponse& response) {
  for (int round = 1;; ++round) {
    if (auto failure = upload_missing(client, package, files, quiet)) return failure;
    const auto failure = client.call("Jobs/Submit", request, response, FarmClient::kLongCall);
    if (!failure) return std::nullopt;
    // Files that were there may have been removed since, with the last job that had them.
    if (failure->missing.empty() || round == kMostUploads) return failure;
  }
}

/// Somebody else's job may name any file of who submits it: they see which ones of those go to the
/// farm that lie elsewhere than the job.
void tell_files_elsewhere(const farm::JobPackage& package, const std::string& job) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path folder = fs::canonical(fs::absolute(job, failed).parent_path(), failed);
  std::vector<std::string> elsewhere;
  for (const core::AssetRecord& file : package.files) {
    const fs::path led = fs::canonical(folder / file.reference, failed);
    if (failed && core::is_not_there(failed)) continue;  // made of others
    if (!failed && core::is_inside(led, folder)) continue;
    elsewhere.push_back(failed ? file.reference : led.string());
  }
  if (elsewhere.empty()) return;
  std::string text = fmt::format("sends {} from outside of the job's folder:",
                                 core::counted(elsewhere.size(), "file"));
  for (const std::string& file : elsewhere) text += "\n  " + file;
  std::fprintf(stderr, "%s\n", core::printable_lines(text).c_str());
}

/// Whoever submits hears in time that their token ends. An older coordinator does not say so.
void tell_expiry(const ClientApp& app) {
  const auto client = app.connect_impatiently();
  v1::WhoAmIResponse me;
  if (!client || client->call("Admin/WhoAmI", v1::WhoAmIRequest(), me)) return;
  const std::string when = farm::expiry_warning({me.expires_ms(), me.warn_ms()}, core::wall_ms());
  if (when.empty()) return;
  std::fprintf(stderr, "hyades submit: WARNING: your token %s: ask an admin for another\n",
               when.c_str());
}

}  // namespace

int submit_command(int argc, char** argv) {
  ClientApp app("submit", "Gives a job and all files that it needs to the farm.");
  SubmitOptions options;
  declare_submit(app.app(), options);
  if (const auto status = app.parse(argc, argv)) return *status;
  std::unique_ptr<BlendJob> blend;  // has its files until they are uploaded
  if (is_blend_file(options.path)) {
    auto made = BlendJob::make(options.path, options.frames);
    if (!made) return app.report({kBadArguments, made.error().message});
    blend = std::move(*made);
  }
  const auto files =
      core::JobFiles::open(blend ? blend->path() : options.path, job_file_options(options.scene));
  if (!files) return app.report({kBadArguments, files.error().message});
  core::JobFiles& door = **files;
  const auto package = farm::package_job(door.document(), options.path, door.files());
  print_notes(door.notes());
  if (!package) {
    print_error(package.error(), options.path);
    return kBadArguments;
  }
  const auto request = make_request(*package, options);
  if (!request) return app.report({kBadArguments, request.error().message});
  if (!options.quiet && !blend) tell_files_elsewhere(*package, options.path);
  const auto client = app.connect();
  if (!client) return kBadArguments;
  v1::SubmitResponse taken;
  if (auto failure = submit(*client, *package, door, *request, options.quiet, taken)) {
    return app.report(*failure);
  }
  for (const std::string& warning : taken.warnings()) {
    std::fprintf(stderr, "warning: %s\n", core::printable(warning).c_str());
  }
  v1::Job job = taken.job();
  if (!options.json) {
    std::printf("job %lu: %s, %s\n", job.id(), core::printable(job.name()).c_str(),
                core::counted(job.frames(), "frame").c_str());
  }
  std::fflush(stdout);
  tell_expiry(app);
  Outcome failure;
  if (options.watch) failure = watch_job(*client, job.id(), options.quiet, &job);
  if (options.json) print_json(to_json(job));
  return failure ? app.report(*failure) : kDone;
}

}  // namespace hyades::cli
