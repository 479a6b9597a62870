#include "worker/render/scene_shelf.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "core/job/layers.h"
#include "core/scene/build_scene.h"
#include "farm/job_package.h"
#include "farm/wire.h"
#include "worker/render/process_memory.h"

namespace hyades::worker {
namespace {

/// Frames of one job that stay loaded while there is memory: one in work, one that comes next, one
/// whose stragglers may still be leased.
constexpr size_t kFramesKept = 3;

}  // namespace

std::shared_ptr<core::TexelStore> SceneShelf::make_texel_store(uint64_t memory, TexelFile texels) {
  const uint64_t budget = memory > 0 ? memory / 4 : core::TexelStore::default_budget();
  return std::make_shared<core::TexelStore>(budget, std::move(texels.file), texels.most);
}

void SceneShelf::add_job(uint64_t job, hyades::v1::JobSpec spec) {
  const core::MutexLock lock(mutex_);
  jobs_[job].spec = std::move(spec);
}

void SceneShelf::forget_job(uint64_t job) {
  const core::MutexLock lock(mutex_);
  jobs_.erase(job);
}

std::shared_ptr<const ShelvedFrame> SceneShelf::find(uint64_t job, int32_t frame) {
  const core::MutexLock lock(mutex_);
  const auto shelved = jobs_.find(job);
  if (shelved == jobs_.end()) return nullptr;
  shelved->second.used = ++uses_;
  const auto found = shelved->second.frames.find(frame);
  if (found == shelved->second.frames.end()) return nullptr;
  found->second.used = uses_;
  return found->second.frame;
}

core::Result<std::shared_ptr<const ShelvedFrame>> SceneShelf::load(uint64_t job, int32_t frame) {
  if (auto there = find(job, frame)) return there;
  hyades::v1::JobSpec spec;
  std::shared_ptr<LoadedJob> loaded;
  {
    const core::MutexLock lock(mutex_);
    const auto shelved = jobs_.find(job);
    if (shelved == jobs_.end()) return core::Error{"the job is not there"};
    spec = shelved->second.spec;
    loaded = shelved->second.loaded;
  }
  make_room(job);
  if (!loaded) {
    auto read_now = read(spec);
    if (!read_now) return read_now.error();
    loaded = *read_now;
  }
  auto scene = core::build_scene(loaded->job, frame, *loaded->cache);
  if (!scene) return scene.error();
  auto ready = std::make_shared<const ShelvedFrame>(ShelvedFrame{
      core::FrameRenderer(*scene, loaded->job, frame, loaded->layers),
      core::render_window(loaded->job.film), loaded->job.sampling.samples, spec.document()});
  const core::MutexLock lock(mutex_);
  const auto shelved = jobs_.find(job);
  if (shelved != jobs_.end()) {
    shelved->second.loaded = loaded;
    shelved->second.frames[frame] = {ready, ++uses_};
  }
  return ready;
}

core::Result<std::shared_ptr<SceneShelf::LoadedJob>> SceneShelf::read(
    const hyades::v1::JobSpec& spec) const {
  std::vector<core::AssetRecord> manifest;
  for (const hyades::v1::JobFile& file : spec.files()) {
    manifest.push_back({file.path(), farm::hex_from_wire(file.sha256()), file.size()});
  }
  auto loaded = std::make_shared<LoadedJob>();
  loaded->files = std::make_unique<farm::ManifestResolver>(manifest, store_);
  auto job = farm::read_job(spec.document(), spec.document(), *loaded->files);
  if (!job) {
    // It has been read before it was taken up.
    return job.error().in("this worker cannot read the job; is it older than the coordinator?");
  }
  loaded->job = std::move(job->job);
  if (spec.samples() > 0) loaded->job.sampling.samples = spec.samples();
  loaded->layers = core::needed_layers(loaded->job);
  loaded->cache = std::make_unique<core::SceneCache>(*loaded->files, texels_);
  return loaded;
}

/// Drops the frame that nobody renders and that was not used for longest, of those jobs that have
/// more than `frames_kept`; where there is none, what the frames of another idle job share.
bool SceneShelf::drop_one_locked(uint64_t but_job, size_t frames_kept) {
  ShelvedJob* of_job = nullptr;
  std::map<int32_t, LoadedFrame>::iterator oldest;
  for (auto& [id, job] : jobs_) {
    if (job.frames.size() <= frames_kept) continue;
    for (auto it = job.frames.begin(); it != job.frames.end(); ++it) {
      if (it->second.frame.use_count() > 1) continue;
      if (of_job != nullptr && oldest->second.used < it->second.used) continue;
      of_job = &job;
      oldest = it;
    }
  }
  if (of_job != nullptr) {
    of_job->frames.erase(oldest);
    return true;
  }
  ShelvedJob* idle = nullptr;
  for (auto& [id, job] : jobs_) {
    if (id == but_job || !job.loaded || !job.frames.empty()) continue;
    if (idle == nullptr || job.used < idle->used) idle = &job;
  }
  if (idle == nullptr || frames_kept > 0) return false;
  idle->loaded.reset();
  return true;
}

void SceneShelf::make_room(uint64_t job) {
  // One more is to come, which may take as much as what is there: keep a third of the budget free.
  const auto tight = [this] { return memory_ > 0 && resident_memory() > memory_ / 3 * 2; };
  for (;;) {
    {
      const core::MutexLock lock(mutex_);
      if (!drop_one_locked(job, kFramesKept - 1) && (!tight() || !drop_one_locked(job, 0))) return;
    }
    trim_memory();
  }
}

}  // namespace hyades::worker
