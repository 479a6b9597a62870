#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "core/base/assets.h"
#include "core/image/exr_support.h"
#include "core/image/read_image.h"

namespace hyades::core {

Result<std::vector<std::pair<std::string, std::string>>> read_exr_texts(const std::string& path) {
  const auto file = map_file(path);
  if (!file) return file.error().in(path);
  prepare_openexr();
  if (const Status header = check_exr_header(file->span(), {}); !header)
    return header.error().in(path);
  std::vector<std::pair<std::string, std::string>> texts;
  try {
    MemoryIStream stream(file->span());
    const Imf::MultiPartInputFile parts(stream, 0, false);
    const Imf::Header& header = parts.header(0);
    for (auto i = header.begin(); i != header.end(); ++i) {
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
        texts.emplace_back(i.name(), text->value());
    }
  } catch (const std::exception& e) {
    return Error{path + ": " + e.what()};
  }
  return texts;
}

}  // namespace hyades::core
