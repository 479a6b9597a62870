#pragma once

#include <functional>

#include "core/scene/appearance.h"

namespace hyades::core {

/// A texture on the mapping of `desc` (in the job's unit of length; `preferred` where it says
/// `default`): make(mapping), or three of those for the three planes of a triplanar one.
Result<TexturePtr> make_mapped(const TextureDesc& desc, const Appearance& looks,
                               MappingSpace preferred,
                               const std::function<Result<TexturePtr>(const MappingDesc&)>& make);

}  // namespace hyades::core
