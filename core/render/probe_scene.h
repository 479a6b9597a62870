#pragma once

#include <memory>
#include <string>

#include "core/base/assets.h"

namespace hyades::core {

/// The job that measures a machine's class. Changing it, or an asset, changes every class.
extern const char* const kProbeJob;

/// The probe's files, made in memory: a wavy mesh ("wave.obj") and a sky ("sky.hdr").
std::unique_ptr<AssetResolver> make_probe_assets();

}  // namespace hyades::core
