#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/job/yaml_tree.h"

namespace hyades::core::lua {

/// What a script says at several frames.
struct FrameTree {
  int32_t frame = 1;
  YamlPtr tree;
};

/// `tree` with what is equal in `first`, which is kept once then; `different` grows by the values
/// that are not, and by those for whose memory their texts and the lists around them would stand.
YamlPtr share_equal(const YamlPtr& first, const YamlPtr& tree, uint64_t& different);

/// One tree that is each of `trees` (at least one, by rising frame) at its frame: what differs
/// becomes `{keys: {1: ..., 2: ...}}`, numbers and lists of numbers on straight lines from frame to
/// frame, colours by steps. Errors name the path of what cannot change within a job: keys that are
/// not there in every frame, lists of other lengths, names, files and switches.
Result<YamlPtr> join_frames(const std::vector<FrameTree>& trees);

}  // namespace hyades::core::lua
