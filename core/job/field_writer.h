#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/assets.h"
#include "core/job/animated.h"
#include "core/job/fields.h"
#include "core/job/job.h"

namespace hyades::core {

/// Writes "path=value" lines for resolved_job_text.
class FieldWriter : public FieldVisitor<FieldWriter> {
 public:
  struct Line {
    std::string key;  ///< below what was entered when the writer began to collect
    std::string value;
    bool operator==(const Line&) const = default;
  };

  /// `ahead`: frames look at the meshes of the one after them.
  FieldWriter(std::vector<JobTime> moments, const std::vector<AssetRecord>& assets,
              bool ahead = false);

  void put(std::string_view key, const std::string& text);
  void put(std::string_view key, const char* text) { put(key, std::string(text)); }
  void put(std::string_view key, int64_t value);
  void put(std::string_view key, int32_t value) { put(key, int64_t{value}); }
  void put(std::string_view key, uint32_t value) { put(key, int64_t{value}); }
  void put(std::string_view key, uint64_t value);
  void put(std::string_view key, bool value) { put(key, int64_t{value ? 1 : 0}); }
  void put(std::string_view key, float value);
  void put(std::string_view key, const Vec3& value);
  void put(std::string_view key, const Mat4& value);
  void put(std::string_view key, const Animated<float>& value);
  void put(std::string_view key, const Animated<Vec2>& value);
  void put(std::string_view key, const Animated<Vec3>& value);
  /// A rotation.
  void put(std::string_view key, const Animated<Vec4>& value);
  void put(std::string_view key, const ColorInput& value);
  void put(std::string_view key, const ScalarInput& value);

  void put(std::string_view key, const TransformList& steps);

  /// A file by the hash of its content, or by its name where the hash is not known.
  void put_file(std::string_view key, const std::string& reference);
  /// Assets that no put_file has named, but for those in `except`.
  void put_other_files(const std::set<std::string>& except);
  /// The sequences of files that are named so far.
  const std::set<std::string>& sequences() const { return sequences_; }

  /// Keys until the matching leave() stand below `name`.
  void enter(std::string_view name);
  void leave();

  /// The lines that `write` writes, instead of writing them.
  std::vector<Line> collect(const std::function<void()>& write);

  void line(std::string_view key, std::string_view value);

  // As a visitor of keys.
  void file(const KeyName& key, const std::string& reference) { put_file(key.line, reference); }
  /// The file at a frame of the job, of a sequence that and, where frames look ahead and `files`
  /// says so, the next one, as far as they are known.
  void frame_file(const KeyName& key, const std::string& reference, FrameFiles files);
  void children(const KeyName& key, const std::vector<ObjectDesc>& children);
  void light_group(const KeyName& key, const std::string& group) {
    if (!group.empty()) put(key.line, group);
  }
  template <class T>
  void value(std::string_view key, const T& value) {
    put(key, value);
  }
  using FieldVisitor::map;
  /// The lines of a description within another stand beside those of what it belongs to where it
  /// has no name there.
  template <class Desc>
  void map(const KeyName& key, const char* /*section*/, const Desc& desc) {
    enter(key.line);
    Desc::fields(desc, *this);
    leave();
  }

  std::string take() { return std::move(text_); }

 private:
  std::vector<JobTime> moments_;
  std::map<std::string, std::string> hashes_;
  std::set<std::string> named_;
  std::set<std::string> sequences_;
  bool ahead_;
  std::string path_;
  std::vector<size_t> starts_;
  std::string text_;
  std::vector<Line>* collected_ = nullptr;  ///< where lines go instead of text_
};

}  // namespace hyades::core
