#pragma once

#include <string>
#include <vector>

namespace hyades::core {

/// The metals that a conductor may name: those of the table in core/materials, which this room
/// cannot see (a test of the scene room holds the two together).
const std::vector<std::string>& metal_names_in_jobs();

}  // namespace hyades::core
