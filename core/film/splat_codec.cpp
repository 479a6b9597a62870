#include "core/film/splat_codec.h"

#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace hyades::core {
namespace {

using Value = std::array<float, 3>;

/// Whether what a pixel holds is a single splat, whose squares follow from its value.
template <class Sums>
bool is_single(const Sums& sums, Value& value) {
  for (size_t c = 0; c < 3; ++c) value[c] = static_cast<float>(to_double(sums.value[c]));
  return Sums::of(value) == sums;
}

/// Others would not come back as they were, and NaN never was a splat.
bool is_splat(const Value& value) {
  return std::abs(value[0]) <= kMaxDeposit && std::abs(value[1]) <= kMaxDeposit &&
         std::abs(value[2]) <= kMaxDeposit;
}

}  // namespace

template <class Sums>
void append_splats(std::vector<std::byte>& out, const BasicSplatLayer<Sums>& layer) {
  std::vector<uint32_t> gaps;
  std::vector<std::byte> singles;  // a bit each
  std::vector<Value> values;
  std::vector<Sums> others;
  uint32_t next = 0;
  layer.for_each([&](uint32_t pixel, const Sums& sums) {
    const size_t i = gaps.size();
    gaps.push_back(pixel - next);
    next = pixel + 1;
    if (i % 8 == 0) singles.push_back(std::byte{0});
    Value value{};
    if (is_single(sums, value)) {
      singles.back() |= std::byte{1} << (i % 8);
      values.push_back(value);
    } else {
      others.push_back(sums);
    }
  });
  append_planes(out, std::as_bytes(std::span(gaps)), sizeof(uint32_t));
  append_planes(out, singles, 1);
  append_planes(out, std::as_bytes(std::span(values)), sizeof(Value));
  append_planes(out, std::as_bytes(std::span(others)), sizeof(Sums));
}

template <class Sums>
Status read_splats(ByteReader& in, uint32_t count, BasicSplatLayer<Sums>& layer) {
  const Error damaged{"its splats are damaged"};
  std::vector<uint32_t> gaps(count);
  std::vector<std::byte> singles((uint64_t{count} + 7) / 8);
  if (!read_planes(in, std::as_writable_bytes(std::span(gaps)), sizeof(uint32_t)) ||
      !read_planes(in, singles, 1)) {
    return damaged;
  }
  const auto single = [&](size_t i) {
    return (singles[i / 8] & (std::byte{1} << (i % 8))) != std::byte{0};
  };
  size_t single_count = 0;
  for (size_t i = 0; i < count; ++i) single_count += single(i) ? 1 : 0;
  std::vector<Value> values(single_count);
  std::vector<Sums> others(count - single_count);
  if (!read_planes(in, std::as_writable_bytes(std::span(values)), sizeof(Value)) ||
      !read_planes(in, std::as_writable_bytes(std::span(others)), sizeof(Sums))) {
    return damaged;
  }

  std::vector<typename BasicSplatLayer<Sums>::Entry> entries(count);
  const auto pixels = static_cast<uint64_t>(layer.region().area());
  uint64_t next = 0;
  auto value = values.begin();
  auto other = others.begin();
  for (size_t i = 0; i < count; ++i) {
    next += gaps[i];
    if (next >= pixels) return damaged;
    entries[i].pixel = static_cast<uint32_t>(next++);
    if (single(i) && !is_splat(*value)) return damaged;
    entries[i].sums = single(i) ? Sums::of(*value++) : *other++;
  }
  layer.add(std::move(entries));
  return {};
}

template void append_splats(std::vector<std::byte>& out, const SplatLayer& layer);
template void append_splats(std::vector<std::byte>& out, const PartSplatLayer& layer);
template Status read_splats(ByteReader& in, uint32_t count, SplatLayer& layer);
template Status read_splats(ByteReader& in, uint32_t count, PartSplatLayer& layer);

}  // namespace hyades::core
