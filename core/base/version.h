#pragma once

namespace hyades::core {

/// The release, as people see it.
inline constexpr const char* kVersion = "0.1.0";

/// Grows whenever the same job would give other pixels: part of every render key.
inline constexpr int kRendererRevision = 1;

}  // namespace hyades::core
