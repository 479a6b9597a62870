#include "core/job/field_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/job/frame_files.h"

namespace hyades::core {

namespace {

std::string bits(float value) { return fmt::format("{:08x}", std::bit_cast<uint32_t>(value)); }

std::string bits(const Vec2& value) { return bits(value.x) + "," + bits(value.y); }

std::string bits(const Vec3& value) {
  return bits(value.x) + "," + bits(value.y) + "," + bits(value.z);
}

std::string bits(const Vec4& value) { return bits(Vec3(value)) + "," + bits(value.w); }

Vec4 value_at(const Animated<Vec4>& value, const JobTime& time) { return rotation_at(value, time); }
template <class T>
T value_at(const Animated<T>& value, const JobTime& time) {
  return value.at(time);
}

/// One value where it does not change over the moments, else all of them.
template <class T>
std::string bits(const Animated<T>& value, const std::vector<JobTime>& moments) {
  if (value.is_constant()) return bits(value.constant);
  std::string all;
  std::string first;
  bool changes = false;
  for (const JobTime& moment : moments) {
    const std::string now = bits(value_at(value, moment));
    if (first.empty()) first = now;
    changes |= now != first;
    all += (all.empty() ? "" : ";") + now;
  }
  return changes ? all : first;
}

}  // namespace

FieldWriter::FieldWriter(std::vector<JobTime> moments, const std::vector<AssetRecord>& assets,
                         bool ahead)
    : moments_(std::move(moments)), ahead_(ahead) {
  for (const AssetRecord& asset : assets) hashes_[asset.reference] = asset.sha256;
}

void FieldWriter::line(std::string_view key, std::string_view value) {
  if (collected_ != nullptr) {
    collected_->push_back({path_ + std::string(key), std::string(value)});
    return;
  }
  text_ += path_;
  text_ += key;
  text_ += '=';
  text_ += value;
  text_ += '\n';
}

void FieldWriter::put(std::string_view key, const std::string& text) {
  // The length keeps a text with line breaks from passing for other fields.
  line(key, fmt::format("{}:{}", text.size(), text));
}
void FieldWriter::put(std::string_view key, int64_t value) { line(key, std::to_string(value)); }
void FieldWriter::put(std::string_view key, uint64_t value) { line(key, std::to_string(value)); }
void FieldWriter::put(std::string_view key, float value) { line(key, bits(value)); }
void FieldWriter::put(std::string_view key, const Vec3& value) { line(key, bits(value)); }

void FieldWriter::put(std::string_view key, const Mat4& value) {
  std::string all;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) all += bits(value[c][r]) + ",";
  }
  line(key, all);
}

void FieldWriter::put(std::string_view key, const Animated<float>& value) {
  line(key, bits(value, moments_));
}
void FieldWriter::put(std::string_view key, const Animated<Vec2>& value) {
  line(key, bits(value, moments_));
}
void FieldWriter::put(std::string_view key, const Animated<Vec3>& value) {
  line(key, bits(value, moments_));
}

void FieldWriter::put(std::string_view key, const Animated<Vec4>& value) {
  line(key, bits(value, moments_));
}

void FieldWriter::put(std::string_view key, const ColorInput& value) {
  if (value.texture.empty()) {
    put(key, value.value);
  } else {
    line(key, "texture " + value.texture);
  }
}

void FieldWriter::put(std::string_view key, const ScalarInput& value) {
  if (value.texture.empty()) {
    put(key, value.value);
  } else {
    line(key, "texture " + value.texture);
  }
}

void FieldWriter::put(std::string_view /*key*/, const TransformList& steps) {
  for (const TransformStep& step : steps) {
    enter("step");
    put("kind", static_cast<int32_t>(step.kind));
    put("vector", step.vector);
    put("angle", step.angle);
    put("quaternion", step.quaternion);
    put("matrix", step.matrix);
    leave();
  }
}

void FieldWriter::put_file(std::string_view key, const std::string& reference) {
  const auto found = hashes_.find(reference);
  if (found == hashes_.end()) {
    put(key, reference);
  } else {
    named_.insert(reference);
    line(key, "sha256 " + found->second);
  }
}

void FieldWriter::frame_file(const KeyName& key, const std::string& reference, FrameFiles files) {
  if (!is_file_sequence(reference)) return put_file(key.line, reference);
  const JobTime& now = moments_.front();
  put_file(key.line, frame_file_at(reference, now));
  const std::string next = frame_file_at(reference, {now.seconds, now.frame + 1.0});
  const bool ahead = ahead_ && files == FrameFiles::own_and_next;
  if (ahead && hashes_.contains(next)) put_file("next", next);
  sequences_.insert(reference);
}

void FieldWriter::put_other_files(const std::set<std::string>& except) {
  for (const auto& [reference, hash] : hashes_) {
    if (named_.contains(reference) || except.contains(reference)) continue;
    put("asset", fmt::format("{} {}", reference, hash));
  }
}

std::vector<FieldWriter::Line> FieldWriter::collect(const std::function<void()>& write) {
  std::vector<Line> lines;
  const std::string outside = std::exchange(path_, "");
  std::vector<Line>* const before = std::exchange(collected_, &lines);
  write();
  collected_ = before;
  path_ = outside;
  return lines;
}

void FieldWriter::enter(std::string_view name) {
  starts_.push_back(path_.size());
  if (name.empty()) return;
  path_ += name;
  path_ += '.';
}

void FieldWriter::leave() {
  path_.resize(starts_.back());
  starts_.pop_back();
}

}  // namespace hyades::core
