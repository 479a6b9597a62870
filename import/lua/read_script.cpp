#include "import/lua/read_script.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/machine.h"
#include "core/base/mutex.h"
#include "core/base/text.h"
#include "core/job/read_sections.h"
#include "core/job/yaml_build.h"
#include "import/lua/join_frames.h"
#include "import/lua/script_run.h"

namespace hyades::core::lua {

namespace {

/// Bytes that all scripts of the program hold of what places() has made.
constexpr size_t kMostMade = size_t{1} << 30;
std::atomic<size_t> made_in_all = 0;

/// A script that asks for the frame runs so often at most.
constexpr int64_t kMostFrames = 10'000;

/// The frames that a tree says; what is wrong in it is for the job's reader to tell.
FramesDesc frames_of(const YamlNode& tree) {
  Job job;
  Diagnostics ignored;
  ReadContext context(job, ignored);
  MapReader top(context, tree, "", "", "job");
  read_frames(top, job.frames);
  return job.frames;
}

class ScriptSource : public SceneSource {
 public:
  ScriptSource(AssetResolver& files, std::string script)
      : files_(files), script_(std::move(script)) {}

  ~ScriptSource() override { made_in_all -= made_bytes_; }
  ScriptSource(const ScriptSource&) = delete;
  ScriptSource& operator=(const ScriptSource&) = delete;

  Result<SceneSections> sections(const SceneRequest& request) const override {
    const std::string key = key_of(request);
    const MutexLock lock(mutex_);
    if (const auto known = told_.find(key); known != told_.end()) return known->second;
    auto tree = tree_at(request);
    if (!tree) return tree.error();
    SceneSections told;
    told.sections = *tree;
    return told_.emplace(key, std::move(told)).first->second;
  }

  Result<Bytes> made_file(const std::string& name) const override {
    const MutexLock lock(mutex_);
    const auto found = made_.find(name);
    if (found != made_.end()) return found->second;
    return Error{script_ + ": '" + name + "' is not made of it"};
  }

 private:
  static std::string key_of(const SceneRequest& request) {
    std::string key = fmt::format("{} {} {}", request.made, request.fps, request.frames);
    for (const auto& [name, value] : request.set) key += "\n" + name + "=" + value;
    return key;
  }

  Result<YamlPtr> tree_at(const SceneRequest& request) const HYADES_REQUIRES(mutex_) {
    if (!request.beside.empty()) {
      return Error{script_ +
                   ": what a script says names files from the script's folder on, "
                   "expected a job in that folder"};
    }
    ScriptRequest run{files_, script_, request.set, request.made};
    if (request.fps > 0.0F) run.fps = request.fps;
    auto first = run_once(run);
    if (!first) return first.error();
    if (!first->asks_frame) return first->tree;
    FramesDesc frames = frames_of(*first->tree);
    if (!request.frames.empty()) {
      frames = frames_of(*YamlMap{{"frames", yaml_word(request.frames)}}.node());
    }
    run.fps = request.fps > 0.0F ? request.fps : frames_of(*first->tree).fps;
    return tree_of_frames(run, frames);
  }

  Result<YamlPtr> tree_of_frames(ScriptRequest& run, const FramesDesc& frames) const
      HYADES_REQUIRES(mutex_) {
    if (frames.last - int64_t{frames.first} >= kMostFrames) {
      return Error{
          fmt::format("{}: the script asks for the frame, and the job has {} frames, "
                      "expected at most {}",
                      script_, frames.last - int64_t{frames.first} + 1, kMostFrames)};
    }
    std::vector<FrameTree> trees;
    uint64_t different = 0;
    const double end = thread_seconds() + run.limits.seconds;
    // One more than are shown, for what moves while the last one's shutter is open.
    for (run.frame = frames.first; run.frame <= frames.last + 1; ++run.frame) {
      run.limits.seconds = end - thread_seconds();
      auto result = run_once(run);
      if (!result) return result.error().in(fmt::format("frame {}", run.frame));
      const YamlPtr first = trees.empty() ? result->tree : trees.front().tree;
      trees.push_back({run.frame, share_equal(first, result->tree, different)});
      if (different <= kMaxYamlNodes) continue;
      return Error{
          fmt::format("{}: its frames differ in more than {} values, expected fewer "
                      "frames, or motion by expressions (docs/lua.md)",
                      script_, kMaxYamlNodes)};
    }
    auto joined = join_frames(trees);
    if (!joined) return told_beside(script_, joined.error());
    return joined;
  }

  Result<ScriptResult> run_once(const ScriptRequest& run) const HYADES_REQUIRES(mutex_) {
    auto result = run_script(run);
    if (!result) return result;
    for (auto& [name, bytes] : result->made) {
      if (made_.contains(name)) continue;
      if (made_in_all + bytes.size() > kMostMade) {
        return Error{fmt::format("{}: more than {} of copies, of all scripts and frames together",
                                 script_, format_bytes(kMostMade))};
      }
      made_in_all += bytes.size();
      made_bytes_ += bytes.size();
      made_.emplace(name, bytes);
    }
    return result;
  }

  AssetResolver& files_;
  std::string script_;
  mutable Mutex mutex_;
  mutable std::map<std::string, SceneSections> told_ HYADES_GUARDED_BY(mutex_);
  mutable std::map<std::string, Bytes> made_ HYADES_GUARDED_BY(mutex_);
  mutable size_t made_bytes_ HYADES_GUARDED_BY(mutex_) = 0;
};

}  // namespace

Result<std::shared_ptr<const SceneSource>> read_script(AssetResolver& files,
                                                       const std::string& reference) {
  return std::shared_ptr<const SceneSource>(std::make_shared<ScriptSource>(files, reference));
}

}  // namespace hyades::core::lua
