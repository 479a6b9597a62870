#pragma once

#include <functional>

#include "core/scene/appearance.h"

namespace hyades::core {

/// A texture on the mapping of `desc` (in the job's unit of length; uv or object where it says
/// `default`): make(mapping), or three of those for the three planes of a triplanar one.
Result<TexturePtr> make_mapped(const textures::Mapped& desc, bool on_uv, const Appearance& looks,
                               const std::function<Result<TexturePtr>(const MappingDesc&)>& make);

}  // namespace hyades::core
