#include <vector>

#include "core/job/old_lines.h"
#include "core/job/resolved_parts.h"

namespace hyades::core {
namespace {

/// From when all objects had lines of all keys.
constexpr OldLine kOldObjectLines[] = {
    {"mesh", kNoText},
    {"next"},
    {"part", nullptr, kNoText},
    {"instance_of", kNoText},
    {"places", nullptr, kNoText},
    {"radius", "3f800000"},
    {"extent", "3f800000,3f800000"},
    {"size", kWhiteBits},
    {"height", "3f800000"},
    {"caps", "1"},
    {"smooth", "4:file"},
    {"displacement.*"},
    {"material"},
    {"interior", nullptr, kNoText},
    {"exterior", nullptr, kNoText},
    {"priority", nullptr, "0"},
    {"override", nullptr, nullptr, "with"},
    {"step.*"},
    {"at"},
    {"emit.*"},
    {"visible_to_camera"},
    {"object.*"},
};

}  // namespace

void write_object(FieldWriter& out, const ObjectDesc& object) {
  write_desc(out, "object", object, kOldObjectLines);
}

void FieldWriter::children(const KeyName& /*key*/, const std::vector<ObjectDesc>& children) {
  for (const ObjectDesc& child : children) write_object(*this, child);
}

}  // namespace hyades::core
