#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/rect.h"

/// What the viewer tev is told over TCP: packets of a length of 4 bytes (of the whole packet), a
/// byte that names the operation, and its fields; numbers are little-endian, texts end with a zero
/// byte. The layouts are those of tev's include/tev/Ipc.h and src/Ipc.cpp, with the third version
/// of updates (since tev 1.17, 2021).
namespace hyades::cli {

/// Makes an empty picture, in place of one that has the name. `focus`: it comes to the front.
std::string create_picture(const std::string& name, bool focus, int width, int height,
                           const std::vector<std::string>& channels);

/// New values of all `channels` in a part of the picture, whose `values` are given row by row, the
/// channels of a pixel together.
std::string update_picture(const std::string& name, const core::PixelRect& part,
                           const std::vector<std::string>& channels, std::span<const float> values);

std::string close_picture(const std::string& name);

}  // namespace hyades::cli
