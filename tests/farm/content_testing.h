#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/base/hash.h"
#include "farm/content_store.h"

namespace hyades::farm {

inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

inline std::string name_of(std::string_view text) { return core::to_hex(core::sha256(text)); }

template <class T>
std::string error_of(const core::Result<T>& result) {
  return result.ok() ? "no error" : result.error().message;
}

inline std::unique_ptr<ContentStore> open_store(const std::string& folder, uint64_t budget = 0) {
  auto store = ContentStore::open({folder, budget});
  EXPECT_TRUE(store) << error_of(store);
  return store ? std::move(*store) : nullptr;
}

/// Stores `text` whole; its name.
inline std::string put(ContentStore& store, std::string_view text) {
  const std::string name = name_of(text);
  auto writer = store.write(name, text.size());
  EXPECT_TRUE(writer) << error_of(writer);
  if (!writer) return name;
  const core::Status appended = writer->append(bytes_of(text).subspan(writer->offset()));
  EXPECT_TRUE(appended) << error_of(appended);
  const core::Status committed = writer->commit();
  EXPECT_TRUE(committed) << error_of(committed);
  return name;
}

}  // namespace hyades::farm
