#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace hyades::core {

/// Immutable bytes with shared ownership: a mapped file, a downloaded asset, a buffer in a test.
class Bytes {
 public:
  Bytes() = default;
  Bytes(std::shared_ptr<const void> owner, std::span<const std::byte> view)
      : owner_(std::move(owner)), view_(view) {}

  std::span<const std::byte> span() const { return view_; }
  size_t size() const { return view_.size(); }
  const char* chars() const { return reinterpret_cast<const char*>(view_.data()); }

 private:
  std::shared_ptr<const void> owner_;
  std::span<const std::byte> view_;
};

}  // namespace hyades::core
