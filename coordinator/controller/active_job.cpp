#include "coordinator/controller/active_job.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "coordinator/scheduler/frame_ledger.h"
#include "coordinator/scheduler/tile_grid.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"
#include "core/job/layers.h"
#include "core/job/noise_threshold.h"
#include "core/job/ocio_files.h"
#include "core/job/video.h"
#include "farm/manifest_resolver.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr int kMostFiles = 100'000;
constexpr int kMostRanges = 10'000;
constexpr size_t kLongestPath = 4096;
/// An open job of one frame with what the scheduler knows of it, without its spec: 5.8 kB by what
/// malloc had given for a thousand of them.
constexpr uint64_t kJobBytes = 6144;
constexpr int64_t kMostFrames = 1'000'000;
constexpr int32_t kLargeTile = 64;
constexpr uint32_t kManySamples = 512;
constexpr uint64_t kEnoughPieces = 512;  ///< of a frame, each one batch of a tile

/// The decimal that was read as `number`.
double as_written(float number) { return std::stod(fmt::format("{}", number)); }

/// The frames that the spec asks for, in order; an error where the document does not have them.
core::Result<std::vector<int32_t>> frames_of(const v1::JobSpec& spec, const core::Job& job) {
  std::vector<int32_t> numbers;
  std::set<int32_t> seen;
  int64_t asked = 0;
  const auto add = [&](int64_t first, int64_t last, int64_t step) -> core::Status {
    if (step < 1 || first > last || first < job.frames.first || last > job.frames.last) {
      return core::Error{
          fmt::format("frames {}-{} (step {}): expected frames within the job's {}-{}", first, last,
                      step, job.frames.first, job.frames.last)};
    }
    asked += (last - first) / step + 1;  // those that are named twice make work too
    if (asked > kMostFrames) return core::Error{"more than a million frames"};
    for (int64_t f = first; f <= last; f += step) {
      const auto number = static_cast<int32_t>(f);
      if (seen.insert(number).second) numbers.push_back(number);
    }
    return {};
  };
  if (spec.frames().empty()) {
    if (auto added = add(job.frames.first, job.frames.last, job.frames.step); !added) {
      return added.error();
    }
  }
  for (const v1::FrameRange& range : spec.frames()) {
    const int64_t step = range.step() == 0 ? 1 : range.step();
    if (auto added = add(range.first(), range.last(), step); !added) return added.error();
  }
  return numbers;
}

/// What names the bits of all films of this spec.
Digest key_of(const v1::JobSpec& spec, const core::LayerSet& layers) {
  std::string text =
      fmt::format("{} {} {}\n", spec.document(), spec.samples(), core::layers_text(layers));
  std::vector<std::string> files;
  for (const v1::JobFile& file : spec.files()) files.push_back(file.path() + '\0' + file.sha256());
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) text += file + '\n';
  return core::sha256(text);
}

/// Where pictures are finished, tables lie to their configuration as in the job: what it names by
/// an absolute path would be looked for among the coordinator's own files.
core::Status check_color_files(const core::Job& job, core::AssetResolver& files) {
  if (!job.color) return {};
  const auto config = files.open(job.color->config);
  if (!config) return config.error();
  const std::vector<std::string>& used = job.color->files;
  for (const std::string& file : core::ocio_file_candidates({config->chars(), config->size()})) {
    if (!file.starts_with('/') || std::find(used.begin(), used.end(), file) == used.end()) continue;
    return core::Error{fmt::format(
        "{} names '{}': expected a path relative to the configuration, as a farm's machines have "
        "no such file",
        job.color->config, file)};
  }
  return {};
}

core::Status check_outputs(const core::Job& job) {
  for (const core::OutputDesc& output : job.outputs) {
    if (farm::wire_text(output.file) != output.file) {
      return core::Error{"output '" + farm::wire_text(output.file) + "': expected UTF-8"};
    }
    if (output.file.size() > kLongestPath) {
      return core::Error{fmt::format("an output's file has a name of {} bytes: at most {}",
                                     output.file.size(), kLongestPath)};
    }
  }
  return {};
}

/// What is asked for of the job's outputs all the time.
void note_outputs(const core::Job& job, ActiveJob& active) {
  if (const core::OutputDesc* output = core::display_output(job)) {
    active.tone_map = output->tone_map;
    active.exposure = output->exposure;
  }
  if (job.videos.empty()) return;
  active.leaves_out_videos = !core::are_all_frames(job, active.numbers);
  if (active.leaves_out_videos) return;
  active.videos = job.videos;
  active.video_frames = core::video_frames(job, {}, active.numbers);
}

uint64_t memory_of(const std::vector<core::VideoDesc>& videos) {
  uint64_t bytes = 0;
  for (const core::VideoDesc& video : videos) {
    bytes += sizeof video + video.where.file.size() + video.file.size() + video.pictures.size();
  }
  return bytes;
}

/// Bytes that it takes to know who has which samples of a frame, when somebody has had some of
/// every tile.
uint64_t ledger_memory(const core::PixelRect& region, uint32_t samples) {
  const auto across = static_cast<uint64_t>(region.width() / kTile + 2);
  const auto down = static_cast<uint64_t>(region.height() / kTile + 2);
  return FrameLedger::memory(across * down, core::batch_count(samples));
}

}  // namespace

int32_t tile_size_of(const core::PixelRect& region, uint32_t samples, bool splats, bool adaptive) {
  if (splats) return kSplatTile;
  if (adaptive) return core::kJudgedTile;
  const auto along = [](int32_t pixels) { return (pixels + kLargeTile - 1) / kLargeTile; };
  const uint64_t pieces = static_cast<uint64_t>(along(region.width())) *
                          static_cast<uint64_t>(along(region.height())) *
                          core::batch_count(samples);
  return samples < kManySamples && pieces >= kEnoughPieces ? kLargeTile : kTile;
}

int32_t tile_size_of(const ActiveJob& job) {
  return tile_size_of(job.region, job.samples, job.layout.layers.splats, job.threshold.adaptive());
}

uint64_t ActiveJob::next_life() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

void ActiveJob::set_busy(bool busy, TimePoint now) {
  if (busy_since != TimePoint{} && now > busy_since) {
    stored.busy_ns += static_cast<uint64_t>(std::chrono::nanoseconds(now - busy_since).count());
  }
  busy_since = busy ? now : TimePoint{};
}

void ActiveJob::account_is_stored(const StoredJob& row) {
  core_ns_stored = row.core_ns;
  busy_ns_stored = row.busy_ns;
}

bool ActiveJob::account_has_grown() const {
  return stored.core_ns != core_ns_stored || stored.busy_ns != busy_ns_stored;
}

bool ActiveJob::is_worked_on(uint32_t leased) const {
  return !ending && (leased > 0 || making_videos || frames_finishing() > 0);
}

uint32_t ActiveJob::frames_finishing() const {
  uint32_t finishing = 0;
  for (const int32_t frame : in_work) {
    const auto noted = frames.find(frame);
    if (noted != frames.end() && noted->second.state == v1::FRAME_STATE_FINISHING) ++finishing;
  }
  return finishing;
}

void ActiveJob::note_finish(double seconds) {
  constexpr double kNewest = 0.3;
  finish_seconds += (finish_seconds > 0 ? kNewest : 1) * (seconds - finish_seconds);
}

bool ActiveJob::is_waiting(uint32_t leased) const {
  return stored.state == StoredState::running && !ending && !is_worked_on(leased) &&
         samples_done + samples_spared < stored.samples;
}

FrameNote& ActiveJob::touch(int32_t frame) {
  FrameNote& note = frames[frame];
  changed.erase(note.version);
  note.version = ++version;
  changed.emplace(version, frame);
  in_work.insert(frame);
  return note;
}

void ActiveJob::note(StoredLine line) {
  touch();
  log.add(std::move(line));
}

v1::Job options_of(const StoredJob& job) {
  v1::Job options;
  (void)options.ParseFromString(job.options);  // we have written it
  return options;
}

JobNeeds needs_of(const v1::Job& options) {
  return {{options.tags().begin(), options.tags().end()}, options.memory_bytes()};
}

v1::Job describe(const StoredJob& job) {
  v1::Job wire = options_of(job);
  wire.set_id(job.id);
  wire.set_name(job.name);
  wire.set_owner(job.owner);
  wire.set_owner_proven(job.owner_proven);
  wire.set_priority(job.priority);
  wire.set_state(static_cast<v1::JobState>(job.state));  // the numbers are the same
  wire.set_waiting(job.state == StoredState::running);   // one that is not open yet
  wire.set_frames(job.frames);
  wire.set_frames_done(job.frames_done);
  wire.set_frames_failed(job.frames_failed);
  wire.set_samples(job.samples);
  // Of jobs that an older version has ended what is in frames that were not finished is not known.
  const uint64_t finished = job.frames > 0 ? job.samples / job.frames * job.frames_done : 0;
  wire.set_samples_done(std::max(job.samples_done, finished));
  wire.set_seconds_left(-1);
  wire.set_submitted_ms(job.submitted_ms);
  wire.set_begun_ms(job.begun_ms);
  wire.set_busy_seconds(1e-9 * static_cast<double>(job.busy_ns));
  wire.set_ended_ms(job.ended_ms);
  wire.set_reason(farm::wire_text(job.reason));
  wire.set_core_seconds(1e-9 * static_cast<double>(job.core_ns));
  if (job.preview) wire.set_preview_frame(*job.preview);
  return wire;
}

std::optional<int32_t> ActiveJob::preview_frame() const {
  for (const int32_t frame : in_work) {
    const auto noted = frames.find(frame);
    if (noted == frames.end() || noted->second.samples_done == 0) continue;
    const v1::FrameState state = noted->second.state;
    if (state == v1::FRAME_STATE_RENDERING || state == v1::FRAME_STATE_FINISHING) return frame;
  }
  return stored.preview;
}

v1::Job ActiveJob::describe(uint32_t leased) const {
  v1::Job wire = coordinator::describe(stored);
  const uint64_t samples = expected_samples(samples_done, samples_spared,
                                            stored.samples - samples_spared - samples_done);
  wire.set_samples(samples);
  wire.set_samples_done(samples_done);
  wire.set_leased(leased);
  if (const auto shown = preview_frame()) wire.set_preview_frame(*shown);
  if (threshold.adaptive()) wire.set_noise_aim(as_written(threshold.aim.noise));
  if (noise) wire.set_noise(*noise);
  const uint32_t finishing = frames_finishing();
  wire.set_frames_finishing(finishing);
  // Of one that nobody has in hand it is how fast it was once.
  if (speed.per_second() > 0 && leased > 0) {
    wire.set_samples_per_second(speed.per_second());
    if (speed.tells_rest()) {
      wire.set_seconds_left(static_cast<double>(samples - std::min(samples_done, samples)) /
                            speed.per_second());
    }
  }
  // Frames are finished beside the rendering, one after the other: that may be what takes longest.
  if (finish_seconds > 0 && (finishing > 0 || wire.seconds_left() >= 0)) {
    const uint32_t over = stored.frames_done + stored.frames_failed;
    double to_finish = finish_seconds * (stored.frames - std::min(over, stored.frames));
    if (finishing_since > 0) {
      const double had = 1e-6 * static_cast<double>(core::wall_us() - finishing_since);
      to_finish -= std::clamp(had, 0.0, finish_seconds);
    }
    wire.set_seconds_left(std::max(wire.seconds_left(), to_finish));
  }
  wire.set_waiting(is_waiting(leased));
  if (wire.waiting()) wire.set_reason(farm::wire_text(obstacle));
  if (!row_trouble.empty()) wire.set_reason(farm::wire_text(row_trouble));
  if (!trouble.empty()) wire.set_reason(farm::wire_text(trouble));
  return wire;
}

v1::Frame ActiveJob::describe_frame(int32_t number, const FrameNote& note) const {
  v1::Frame wire;
  wire.set_frame(number);
  wire.set_state(note.state);
  wire.set_samples(expected_samples(note.samples_done, note.samples_spared,
                                    samples_per_frame - note.samples_spared - note.samples_done));
  wire.set_samples_done(note.samples_done);
  if (note.reason) wire.set_reason(farm::wire_text(*note.reason));
  wire.set_worker_class(note.worker_class);
  wire.set_restarts(note.restarts);
  if (note.noise) wire.set_noise(*note.noise);
  wire.set_black(black.contains(number));
  return wire;
}

uint64_t memory_of(const StoredJob& job) { return kJobBytes + job.spec.size(); }

core::Result<std::vector<core::AssetRecord>> files_of(const v1::JobSpec& spec) {
  if (spec.files_size() > kMostFiles) {
    return core::Error{fmt::format("{} files: at most {}", spec.files_size(), kMostFiles)};
  }
  if (spec.frames_size() > kMostRanges) {
    return core::Error{
        fmt::format("{} ranges of frames: at most {}", spec.frames_size(), kMostRanges)};
  }
  if (spec.name().size() > kLongestName) {
    return core::Error{fmt::format("name: at most {} characters", kLongestName)};
  }
  std::vector<core::AssetRecord> records;
  std::set<std::string> paths;
  for (const v1::JobFile& file : spec.files()) {
    const auto digest = farm::digest_from_wire(file.sha256());
    if (!digest) return digest.error().in(file.path());
    if (file.path().empty() || file.path().size() > kLongestPath) {
      return core::Error{"a file without a path, or with one of more than 4096 bytes"};
    }
    if (!paths.insert(file.path()).second) return core::Error{file.path() + ": named twice"};
    records.push_back({file.path(), core::to_hex(*digest), file.size()});
  }
  if (!paths.contains(spec.document())) {
    return core::Error{"the document '" + spec.document() + "' is not among the job's files"};
  }
  return records;
}

core::Result<std::unique_ptr<ActiveJob>> make_active_job(const StoredJob& stored,
                                                         const v1::JobSpec& spec,
                                                         const farm::ReadJob& read,
                                                         farm::ContentStore& assets,
                                                         uint64_t film_memory) {
  const core::Job& job = read.job;
  if (farm::wire_text(job.name) != job.name || job.name.size() > kLongestName) {
    return core::Error{fmt::format("name: expected at most {} bytes of UTF-8", kLongestName)};
  }
  if (const core::Status allowed = check_outputs(job); !allowed) return allowed.error();
  farm::ManifestResolver files(read.assets, assets);
  if (const core::Status portable = check_color_files(job, files); !portable) {
    return portable.error();
  }
  const NotSharedYet alone;
  auto active = std::make_unique<ActiveJob>(stored, spec);
  auto numbers = frames_of(spec, job);
  if (!numbers) return numbers.error();
  active->numbers = std::move(*numbers);
  active->region = core::render_window(job.film);
  const core::LayerSet layers = core::needed_layers(job);
  active->layout = core::make_film_layout(layers);
  active->film_bytes = core::film_memory(active->layout, active->region) +
                       ledger_memory(active->region, job.sampling.samples);
  if (active->film_bytes > film_memory) {
    return core::Error{fmt::format(
        "film: {} x {} pixels of {} channels and {} samples take {} of the coordinator's memory, "
        "which holds at most {} of films (--film-memory); expected a smaller size, a crop, fewer "
        "layers or fewer samples",
        active->region.width(), active->region.height(), active->layout.channels.size(),
        job.sampling.samples, core::format_bytes(active->film_bytes),
        core::format_bytes(film_memory))};
  }
  active->samples = job.sampling.samples;
  active->threshold = core::noise_threshold(job);
  active->samples_per_frame =
      static_cast<uint64_t>(active->region.area()) * uint64_t{active->samples};
  active->key = key_of(spec, layers);
  for (const int32_t frame : active->numbers) active->frames[frame];
  v1::Job options = options_of(stored);
  active->needs = needs_of(options);
  active->needs.render_class = job.render.render_class;
  options.set_frame_rate(core::video_frames(job, {}, active->numbers).rate);
  active->stored.options = options.SerializeAsString();
  active->stored.name = spec.name().empty() ? job.name : spec.name();
  active->stored.frames = static_cast<uint32_t>(active->numbers.size());
  active->stored.samples = active->samples_per_frame * active->numbers.size();
  note_outputs(job, *active);
  active->bytes = memory_of(stored) + memory_of(active->videos);
  return active;
}

}  // namespace hyades::coordinator
