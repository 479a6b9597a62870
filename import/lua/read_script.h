#pragma once

#include <memory>
#include <string>

#include "core/base/assets.h"
#include "import/scene_source.h"

namespace hyades::core::lua {

/// A script in Lua (.lua) that makes a job, as docs/lua.md has it. It runs when its sections are
/// asked for, once per request; where it asks for the frame, once for every frame of the job and
/// the one after. `files` must outlive what is returned.
Result<std::shared_ptr<const SceneSource>> read_script(AssetResolver& files,
                                                       const std::string& reference);

}  // namespace hyades::core::lua
