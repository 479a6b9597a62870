#pragma once

#include <vector>

#include "core/job/read_context.h"

namespace hyades::core {

/// The keys of `other`, overridden by those of `own`, as `like` does it.
YamlPtr merged(const YamlNode& own, const YamlNode& other);

/// Resolves `like: name` among the entries of one map of names: the value becomes a copy of the
/// other's keys, overridden by its own. Where keys exclude each other (`shape` and `mesh`, `metal`
/// and `eta`), an own one also drops the other's. Complains about unknown names and cycles.
std::vector<YamlEntry> resolve_likes(ReadContext& context, const YamlNode& named);

}  // namespace hyades::core
