#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/client/client_app.h"
#include "cli/client/fetch.h"
#include "cli/client/find_job.h"
#include "cli/client/show.h"
#include "cli/client_commands.h"
#include "cli/frame_range.h"
#include "cli/transfer_display.h"
#include "cli/written_file.h"
#include "core/base/folder_links.h"
#include "core/base/hash.h"
#include "core/base/text.h"
#include "core/film/film_codec.h"
#include "core/film/film_exr.h"
#include "farm/wire.h"

namespace hyades::cli {
namespace {

constexpr size_t kMostNamed = 10;

struct FetchOptions {
  std::string job;
  std::string folder = ".";
  std::string frames;
  std::optional<int32_t> film;
  bool follow = false;
  bool list = false;
  bool quiet = false;
  bool json = false;
  bool hidden = false;
  bool overwrite = false;
};

/// What a job is called in FetchRecord: id and moment.
Outcome name_job(FarmClient& client, uint64_t id, std::string& name) {
  v1::GetJobRequest request;
  request.set_job(id);
  request.set_after(INT32_MAX);  // none of its frames
  v1::GetJobResponse response;
  if (auto failure = client.call("Jobs/Get", request, response)) return failure;
  name = fmt::format("{} {}", id, response.job().submitted_ms());
  return std::nullopt;
}

FetchTarget target_of(const FetchOptions& options, std::string job) {
  FetchTarget target(options.folder);
  target.job = std::move(job);
  target.hidden = options.hidden;
  target.overwrite = options.overwrite;
  return target;
}

void declare(CLI::App& app, FetchOptions& options) {
  app.add_option("job", options.job, "its id, or its name (of several: the newest)")->required();
  declare_output_folder(app, options.folder, "folder for the files");
  app.add_option("--frames,--frame", options.frames, "only these frames: 7,8 or 1-10 or 1-10x2")
      ->check(frame_list_error);
  app.add_flag("--follow", options.follow, "stay, and bring each file as it is finished");
  app.add_option("--film", options.film,
                 "instead, this frame's film as it is now, also in mid-render (for 'hyades merge' "
                 "or any EXR viewer)");
  app.add_flag("--overwrite", options.overwrite,
               "replace files that are there, whoever has written them");
  app.add_flag("--hidden", options.hidden, "write files whose names begin with '.' or '-', too");
  app.add_flag("--list", options.list, "only tell which files there are");
  app.add_flag("-q,--quiet", options.quiet, "show no progress");
  app.add_flag("--json", options.json, "print the files as JSON (field id: the path)");
  app.footer(
      "examples:\n"
      "  hyades fetch perlin-sphere --output out\n"
      "  hyades fetch 12 --frames 7,8 --follow\n"
      "  hyades fetch 12 --film 7\n"
      "Goes on where an earlier run stopped; every file is checked against its SHA-256 before it "
      "gets its\n"
      "name, and those that are there already are left alone. Others that are there are not "
      "replaced,\n"
      "but for what a fetch of the same job has written and nobody has changed (.hyades/fetched in "
      "the\n"
      "folder has the list).\n"
      "exit status: 0 all that was asked for and is finished is here, 1 something failed, a frame "
      "of "
      "the job has\n"
      "failed, or there is nothing to fetch yet; others: docs/client.md");
}

Json output_to_json(const v1::OutputFile& file) {
  core::Sha256 digest{};
  std::copy_n(file.sha256().begin(), std::min(file.sha256().size(), digest.size()), digest.begin());
  return {{"id", file.path()},
          {"frame", file.frame()},
          {"size", file.size()},
          {"sha256", core::to_hex(digest)}};
}

/// Writes what there is of a frame's film to NAME.FRAME.film.exr.
Outcome fetch_film(FarmClient& client, uint64_t id, const std::string& job,
                   const FetchOptions& options) {
  v1::FilmHeader header;
  std::string bytes;
  TransferDisplay display("fetching", options.quiet);
  const auto on_bytes = [&](uint64_t more) {
    if (display.transfer().total == 0) display.expect(header.size());
    display.moved(more);
  };
  if (auto failure = client.film(id, *options.film, header, bytes, on_bytes)) return failure;
  display.clear();
  auto info = farm::from_wire(header);
  if (!info) return Failure{kFailed, info.error().in("the film that came").message};
  auto film = core::decode_film(std::as_bytes(std::span(bytes)), client.film_limits(bytes));
  if (!film) return Failure{kFailed, film.error().in("the film that came").message};
  const std::string name = fmt::format("{}.{:04}.film.exr", header.job_name(), *options.film);
  FetchTarget target = target_of(options, job);
  if (auto refused = target.check_name(name)) return refused;
  if (!target.may_write(name)) return not_replaced({name}, options.folder);
  std::error_code failed;
  std::filesystem::create_directories(options.folder, failed);
  const std::string path = options.folder + "/" + name;
  // Films are written through links.
  if (auto stays = core::stays_in_folder(options.folder, path); !stays) {
    return Failure{kFailed, stays.error().message};
  }
  auto written = core::write_film_exr(path, {std::move(*info), std::move(*film)});
  if (!written) return Failure{kFailed, written.error().message};
  if (auto failure = target.note(name, sha256_of_file(path))) return failure;
  if (!options.quiet) std::fprintf(stderr, "wrote %s\n", core::printable(path).c_str());
  return std::nullopt;
}

/// Why there is no file to fetch.
Failure why_nothing(const v1::Job& job) {
  const uint64_t id = job.id();
  switch (job.state()) {
    case v1::JOB_STATE_FAILED:
      return {kFailed, fmt::format("job {} failed, there is nothing to fetch: hyades status {} "
                                   "tells why, hyades retry {} renders it again",
                                   id, id, id)};
    case v1::JOB_STATE_CANCELLED:
      return {kFailed, fmt::format("job {} was cancelled, there is nothing to fetch: hyades retry "
                                   "{} renders the rest",
                                   id, id)};
    case v1::JOB_STATE_DONE:
      return {kFailed, fmt::format("job {} is done and has no files", id)};
    default:
      return {kFailed, fmt::format("job {} has nothing to fetch yet (hyades watch {})", id, id)};
  }
}

/// "4, 7-9", the first few of them.
std::string in_words(const std::vector<int32_t>& frames) {
  std::string text;
  size_t parts = 0;
  for (size_t i = 0; i < frames.size(); ++parts) {
    if (parts == kMostNamed) return text + ", ...";
    size_t last = i;
    while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1) ++last;
    if (parts > 0) text += ", ";
    text += std::to_string(frames[i]);
    if (last > i) text += "-" + std::to_string(frames[last]);
    i = last + 1;
  }
  return text;
}

/// What is not here of what was asked for: a failure where it will not come by itself. Else
/// standard error tells of it unless `quiet`.
Outcome what_is_missing(const v1::GetJobResponse& response, const std::vector<int32_t>& asked,
                        bool quiet) {
  const v1::Job& job = response.job();
  std::vector<int32_t> failed;
  size_t unfinished = 0;
  for (const v1::Frame& frame : response.frames()) {
    if (!asked.empty() && std::find(asked.begin(), asked.end(), frame.frame()) == asked.end()) {
      continue;
    }
    if (frame.state() == v1::FRAME_STATE_FAILED) failed.push_back(frame.frame());
    if (frame.state() != v1::FRAME_STATE_FAILED && frame.state() != v1::FRAME_STATE_DONE) {
      ++unfinished;
    }
  }
  if (!failed.empty()) {
    return Failure{kFailed, fmt::format("of job {} {} {} failed and {} no files: hyades status {} "
                                        "tells why, hyades retry {} renders {} again",
                                        job.id(), failed.size() == 1 ? "frame" : "frames",
                                        in_words(failed), failed.size() == 1 ? "has" : "have",
                                        job.id(), job.id(), failed.size() == 1 ? "it" : "them")};
  }
  if (job.state() == v1::JOB_STATE_CANCELLED && asked.empty()) {
    return Failure{kFailed, fmt::format("job {} was cancelled when {} of its {} frames were done: "
                                        "hyades retry {} renders the rest",
                                        job.id(), job.frames_done(), job.frames(), job.id())};
  }
  if (unfinished > 0 && !quiet) {
    std::fprintf(stderr, "%zu frame%s not finished yet (--follow waits for %s)\n", unfinished,
                 unfinished == 1 ? " is" : "s are", unfinished == 1 ? "it" : "them");
  }
  return std::nullopt;
}

/// One run of the command.
class FetchRun {
 public:
  /// `frames`: empty for all.
  FetchRun(FarmClient& client, const FetchOptions& options, uint64_t id, std::string job,
           const std::vector<int32_t>& frames)
      : client_(client),
        options_(options),
        id_(id),
        frames_(frames),
        target_(target_of(options, std::move(job))),
        display_("fetching", options.quiet || options.list) {}

  Outcome run() {
    v1::OutputsRequest request;
    request.set_job(id_);
    request.set_follow(options_.follow);
    for (const int32_t frame : frames_) {
      v1::FrameRange& range = *request.add_frames();
      range.set_first(frame);
      range.set_last(frame);
    }
    // Which files there are is heard first, so that it is known how much is to come; those that are
    // waited for come one by one.
    std::vector<v1::OutputFile> files;
    uint64_t bytes = 0;
    Outcome failure = client_.outputs(request, [&](const v1::OutputFile& file) -> Outcome {
      if (auto too_many = client_.count_part(file, bytes)) return too_many;
      if (options_.follow) return take(file);
      files.push_back(file);
      return std::nullopt;
    });
    for (const v1::OutputFile& file : files) {
      if (failure) break;
      if (!options_.list && is_new(file)) display_.expect(file.size());
    }
    if (!options_.follow) seen_.clear();  // they were counted, not fetched
    for (size_t i = 0; i < files.size() && !failure; ++i) failure = take(files[i]);
    display_.clear();
    if (!failure && !totals_.refused.empty()) {
      failure = not_replaced(totals_.refused, options_.folder);
    }
    return failure;
  }

  void print() const {
    if (options_.json) {
      print_json(told_);
    } else if (!options_.list && !options_.quiet && totals_.files > 0) {
      std::fprintf(
          stderr, "%s in %s, %s fetched%s\n", core::counted(totals_.files, "file").c_str(),
          core::printable(options_.folder).c_str(), core::format_bytes(totals_.bytes).c_str(),
          totals_.present > 0 ? fmt::format(" ({} were there)", totals_.present).c_str() : "");
    }
  }

  bool found_nothing() const { return seen_.empty(); }

 private:
  /// After a break the stream begins again.
  bool is_new(const v1::OutputFile& file) {
    return seen_.insert(file.path() + file.sha256()).second;
  }

  Outcome take(const v1::OutputFile& file) {
    if (!is_new(file)) return std::nullopt;
    if (options_.json) told_.push_back(output_to_json(file));
    if (options_.list) {
      if (!options_.json) {
        std::printf("%s  %s\n", core::printable(file.path()).c_str(),
                    core::format_bytes(file.size()).c_str());
      }
      return std::nullopt;
    }
    if (options_.follow) display_.expect(file.size());
    display_.begin_file(core::printable(file.path()));
    uint64_t came = 0;
    const Outcome failure = fetch_file(
        client_, id_, file, target_,
        [&](uint64_t bytes) {
          came += bytes;
          display_.moved(bytes);
        },
        totals_);
    display_.spare(file.size() - std::min(came, file.size()));
    return failure;
  }

  FarmClient& client_;
  const FetchOptions& options_;
  uint64_t id_;
  std::vector<int32_t> frames_;
  FetchTarget target_;
  TransferDisplay display_;
  std::set<std::string> seen_;
  Fetched totals_;
  Json told_ = Json::array();
};

}  // namespace

int fetch_command(int argc, char** argv) {
  ClientApp app("fetch", "Brings a job's finished pictures to this machine.");
  FetchOptions options;
  declare(app.app(), options);
  if (const auto status = app.parse(argc, argv)) return *status;
  const auto client = app.connect();
  if (!client) return kBadArguments;
  uint64_t id = 0;
  if (auto failure = find_job(*client, options.job, Namesakes::newest, id))
    return app.report(*failure);
  std::string name;
  if (auto failure = name_job(*client, id, name)) return app.report(*failure);
  if (options.film) {
    const Outcome failure = fetch_film(*client, id, name, options);
    return failure ? app.report(*failure) : kDone;
  }
  std::vector<int32_t> frames;
  if (auto failure = select_frames(*client, id, options.frames, frames)) {
    return app.report(*failure);
  }
  FetchRun run(*client, options, id, std::move(name), frames);
  const Outcome failure = run.run();
  run.print();
  if (failure) return app.report(*failure);
  if (options.list) return kDone;
  v1::GetJobResponse now;
  if (auto gone = client->get(id, now)) return app.report(*gone);
  if (run.found_nothing()) return app.report(why_nothing(now.job()));
  const Outcome missing = what_is_missing(now, frames, options.quiet || options.json);
  return missing ? app.report(*missing) : kDone;
}

}  // namespace hyades::cli
