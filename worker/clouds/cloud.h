#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hyades::worker {

/// Whose machine this is.
enum class Cloud : uint8_t { aws, gcp, azure };

/// "aws", "gcp" or "azure".
const char* name_of(Cloud cloud);

/// The cloud that the machine's firmware names, as Linux tells it below `sys`: by reading files
/// only, nothing is sent anywhere. Nothing where it is none of the three.
std::optional<Cloud> find_cloud(const std::string& sys = "/sys");

}  // namespace hyades::worker
