#include "import/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>

namespace hyades::core {

namespace {

template <class T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// One component as To; Normal: an integer type's range stands for -1..1 or 0..1 (glTF 2.0, section
/// 3.6.2.2).
template <class To, class From, bool Normal>
To convert(const std::byte* at) {
  const From value = load<From>(at);
  if constexpr (Normal && std::is_integral_v<From>) {
    const float scaled =
        static_cast<float>(value) / static_cast<float>(std::numeric_limits<From>::max());
    return static_cast<To>(std::max(scaled, -1.0F));
  } else {
    return static_cast<To>(value);
  }
}

/// `count` elements of N components that lie `stride` apart.
template <class To, class From, bool Normal>
void gather(const std::byte* from, size_t stride, size_t count, size_t components, To* to) {
  if (std::is_same_v<To, From> && stride == components * sizeof(From)) {
    std::memcpy(to, from, count * stride);
    return;
  }
  for (size_t i = 0; i < count; ++i) {
    const std::byte* at = from + i * stride;
    for (size_t k = 0; k < components; ++k) {
      *to++ = convert<To, From, Normal>(at + k * sizeof(From));
    }
  }
}

template <class To>
void gather(const GltfAccessor& accessor, const std::byte* from, size_t stride, size_t count,
            To* to) {
  const size_t n = accessor.components;
  const bool normal = accessor.normalized && std::is_floating_point_v<To>;
  switch (accessor.component) {
    case GltfComponent::int8:
      return normal ? gather<To, int8_t, true>(from, stride, count, n, to)
                    : gather<To, int8_t, false>(from, stride, count, n, to);
    case GltfComponent::uint8:
      return normal ? gather<To, uint8_t, true>(from, stride, count, n, to)
                    : gather<To, uint8_t, false>(from, stride, count, n, to);
    case GltfComponent::int16:
      return normal ? gather<To, int16_t, true>(from, stride, count, n, to)
                    : gather<To, int16_t, false>(from, stride, count, n, to);
    case GltfComponent::uint16:
      return normal ? gather<To, uint16_t, true>(from, stride, count, n, to)
                    : gather<To, uint16_t, false>(from, stride, count, n, to);
    case GltfComponent::uint32:
      return gather<To, uint32_t, false>(from, stride, count, n, to);
    case GltfComponent::float32:
      return gather<To, float, false>(from, stride, count, n, to);
  }
}

const std::byte* bytes_of(const GltfModel& model, int view, size_t offset) {
  return model.views[static_cast<size_t>(view)].bytes.span().data() + offset;
}

uint32_t sparse_index(const std::byte* from, GltfComponent type, size_t i) {
  if (type == GltfComponent::uint8) return load<uint8_t>(from + i);
  if (type == GltfComponent::uint16) return load<uint16_t>(from + 2 * i);
  return load<uint32_t>(from + 4 * i);
}

template <class To>
Status put_sparse(const GltfModel& model, const GltfAccessor& accessor, std::vector<To>& out) {
  const GltfSparse& sparse = *accessor.sparse;
  if (sparse.count == 0) return {};
  const size_t n = accessor.components;
  std::vector<To> values(sparse.count * n);
  gather(accessor, bytes_of(model, sparse.value_view, sparse.value_offset), accessor.element_size(),
         sparse.count, values.data());
  const std::byte* indices = bytes_of(model, sparse.index_view, sparse.index_offset);
  for (size_t i = 0; i < sparse.count; ++i) {
    const uint32_t index = sparse_index(indices, sparse.index_type, i);
    if (index >= accessor.count) {
      return model.error(fmt::format("{}.sparse replaces element {}, but there are {}",
                                     accessor.place, index, accessor.count));
    }
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                out.begin() + static_cast<std::ptrdiff_t>(index * n));
  }
  return {};
}

template <class To>
Result<std::vector<To>> read(const GltfModel& model, int index, size_t components) {
  const GltfAccessor& accessor = model.accessors[static_cast<size_t>(index)];
  if (components != 0 && accessor.components != components) {
    return model.error(fmt::format("{} has elements of {} numbers, expected {}", accessor.place,
                                   accessor.components, components));
  }
  // Elements that no byte stands for must not ask for memory without end.
  if (accessor.view < 0 && accessor.count > model.buffer_bytes) {
    return model.error(fmt::format("{} has {} elements, more than the file has bytes",
                                   accessor.place, accessor.count));
  }
  std::vector<To> out(accessor.count * accessor.components);
  if (accessor.view >= 0) {
    const size_t stride = model.views[static_cast<size_t>(accessor.view)].stride;
    gather(accessor, bytes_of(model, accessor.view, accessor.offset),
           stride != 0 ? stride : accessor.element_size(), accessor.count, out.data());
  }
  if (accessor.sparse) {
    if (Status s = put_sparse(model, accessor, out); !s) return s.error();
  }
  return out;
}

}  // namespace

Result<std::vector<float>> read_floats(const GltfModel& model, int index, size_t components) {
  auto out = read<float>(model, index, components);
  if (!out) return out;
  const bool finite =
      std::all_of(out->begin(), out->end(), [](float x) { return std::isfinite(x); });
  if (!finite) {
    return model.error(model.accessors[static_cast<size_t>(index)].place +
                       " has numbers that are not finite");
  }
  return out;
}

Result<std::vector<uint32_t>> read_whole(const GltfModel& model, int index, size_t components) {
  const GltfAccessor& accessor = model.accessors[static_cast<size_t>(index)];
  if (accessor.component == GltfComponent::float32) {
    return model.error(accessor.place + " has floats, expected whole numbers");
  }
  return read<uint32_t>(model, index, components);
}

}  // namespace hyades::core
