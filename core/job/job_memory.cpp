#include "core/job/job_memory.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

#include "core/job/fields.h"

namespace hyades::core {
namespace {

/// Measured of muParser 2.3.3: each parser has its own tables of functions.
constexpr uint64_t kExpressionBytes = 7000;
constexpr uint64_t kExpressionBytesPerLetter = 40;

/// What malloc takes for `bytes`.
uint64_t block(uint64_t bytes) {
  constexpr uint64_t kHead = 8;
  constexpr uint64_t kStep = 16;
  return bytes == 0 ? 0 : std::max<uint64_t>((bytes + kHead + kStep - 1) / kStep * kStep, 32);
}

/// Adds up what lies behind the members of descriptions, which themselves lie in some block.
class HeapBytes : public FieldVisitor<HeapBytes> {
 public:
  /// Elements that have keys.
  template <class Desc>
  void add_all(const std::vector<Desc>& list) {
    add_block(list);
    for (const Desc& desc : list) add(desc);
  }
  template <class Desc>
  void add(const Desc& desc) {
    if constexpr (requires { desc.name; }) add(desc.name);
    if constexpr (requires { desc.where; }) add(desc.where.file);
    Desc::fields(desc, *this);
  }
  void add(const GroupDesc& group) {
    add(group.name);
    add(group.where.file);
    add_all(group.objects);
  }
  void add(const std::string& text) {
    static const size_t kInPlace = std::string().capacity();
    if (text.capacity() > kInPlace) bytes_ += block(text.capacity() + 1);
  }
  void add(const std::vector<std::string>& texts) {
    add_block(texts);
    for (const std::string& text : texts) add(text);
  }
  template <class T>
  void add(const Animated<T>& value) {
    add_block(value.keys);
    for (const auto& expression : value.expressions) add(expression);
  }
  /// Values share theirs with curves and checks.
  void add(const std::shared_ptr<const Expression>& expression) {
    if (!expression || !expressions_.insert(expression.get()).second) return;
    bytes_ += kExpressionBytes + kExpressionBytesPerLetter * expression->text().size();
  }
  template <class T>
  void add_block(const std::vector<T>& list) {
    bytes_ += block(list.capacity() * sizeof(T));
  }

  // As a visitor of keys.
  template <class T>
  void value(std::string_view /*key*/, const T& /*value*/) {}  // in place
  void value(std::string_view /*key*/, const std::string& text) { add(text); }
  template <class T>
  void value(std::string_view /*key*/, const Animated<T>& value) {
    add(value);
  }
  void value(std::string_view /*key*/, const ColorInput& input) { add_input(input); }
  void value(std::string_view /*key*/, const ScalarInput& input) { add_input(input); }
  void value(std::string_view /*key*/, const TransformList& steps) {
    add_block(steps);
    for (const TransformStep& step : steps) {
      add(step.vector);
      add(step.angle);
      add(step.quaternion);
    }
  }
  void names_of(const KeyName& key, const std::optional<std::vector<std::string>>& names,
                NameKind kind) {
    if (names) add_block(*names);
    FieldVisitor::names_of(key, names, kind);
  }
  void children(const KeyName& /*key*/, const std::vector<ObjectDesc>& objects) {
    add_all(objects);
  }
  template <class Stop>
  void stops(const KeyName& key, const std::vector<Stop>& stops) {
    add_block(stops);
    FieldVisitor::stops(key, stops);
  }
  template <class Pair>
  void overrides(const KeyName& key, const std::vector<Pair>& overrides) {
    add_block(overrides);
    FieldVisitor::overrides(key, overrides);
  }

  uint64_t bytes() const { return bytes_; }

 private:
  template <class Input>
  void add_input(const Input& input) {
    add(input.value);
    add(input.texture);
  }

  uint64_t bytes_ = 0;
  std::unordered_set<const Expression*> expressions_;
};

void add_curves(HeapBytes& heap, const std::vector<Curve>& curves) {
  heap.add_block(curves);
  for (const Curve& curve : curves) {
    heap.add(curve.path);
    std::visit([&](const auto& value) { heap.add(value); }, curve.value);
  }
}

void add_checks(HeapBytes& heap, const ValueChecks& checks) {
  heap.add_block(checks.numbers);
  for (const NumberCheck& check : checks.numbers) {
    heap.add(check.expression);
    heap.add(check.where.file);
    heap.add(check.label);
  }
  heap.add_block(checks.vectors);
  for (const VectorCheck& check : checks.vectors) {
    heap.add(check.value);
    heap.add(check.other);
    heap.add(check.where.file);
    heap.add(check.label);
    heap.add(check.expected);
  }
}

void add_outputs(HeapBytes& heap, const Job& job) {
  heap.add_block(job.outputs);
  for (const OutputDesc& output : job.outputs) {
    heap.add(output.where.file);
    heap.add(output.file);
    heap.add(output.layers);
  }
  heap.add_block(job.videos);
  for (const VideoDesc& video : job.videos) {
    heap.add(video.where.file);
    heap.add(video.file);
    heap.add(video.pictures);
  }
  if (job.color) heap.add(job.color->files);
}

}  // namespace

uint64_t memory_of(const Job& job) {
  HeapBytes heap;
  heap.add(job.includes);
  heap.add(job.camera);
  heap.add_all(job.textures);
  heap.add_all(job.materials);
  heap.add_all(job.media);
  heap.add_all(job.groups);
  heap.add_all(job.objects);
  heap.add_all(job.lights);
  if (job.environment) heap.add(*job.environment);
  add_curves(heap, job.curves);
  add_checks(heap, job.checks);
  add_outputs(heap, job);
  return sizeof(Job) + heap.bytes();
}

}  // namespace hyades::core
