// Pictures of all formats, told by their first bytes.

#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "tests/core/image/image_tools.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/support/temp_folder.h"

namespace hyades::fuzz {
namespace {

/// Bytes of a picture whose writer knows only files.
template <class Write>
std::string through_file(const Write& write) {
  test::TempFolder folder;
  const std::string path = folder.file("picture");
  return write(path) ? test::file_contents(path) : std::string();
}

}  // namespace

std::vector<std::string> seeds() {
  const core::Image color = test::hashed_image(9, 7, {"R", "G", "B"});
  const core::Image alpha = test::hashed_image(9, 7, {"R", "G", "B", "A"});
  return {written([&] {
            return core::encode_png(color, {{"Title", "x"}});
          }),
          written([&] { return core::encode_png(alpha, {}, {16}); }),
          written([&] { return core::encode_exr(color); }),
          written([&] {
            return core::encode_exr(alpha, {{"note", "x"}}, true);
          }),
          through_file([&](const auto& path) { return core::write_jpeg(path, color, 50); }),
          through_file([&](const auto& path) { return core::write_tiff(path, alpha, {}, {16}); }),
          "P6 # a comment\n1 2\n65535\nabcdefghijkl",
          "Pf\n1 2\n-1.5\nabcdefgh",
          std::string("\0\0\x0A\0\0\0\0\0\0\0\0\0\3\0\2\0\x20\x08", 18) + "\x83" + "abcd" + "\x01" +
              "abcdefgh",
          "BM" +
              std::string("\0\0\0\0\0\0\0\0\x3E\0\0\0\x28\0\0\0\3\0\0\0\2\0\0\0\1\0\4\0\0\0\0\0"
                          "\0\0\0\0\0\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0",
                          52) +
              "abcdefgh" + std::string("\1\0\0\0\0\1\0\0", 8),
          "qoif" + std::string("\0\0\0\3\0\0\0\3\4\0\xFE"
                               "abc\x55\xA0\x88\xC1\x05\xFF"
                               "abcd\xC2"
                               "\0\0\0\0\0\0\0\1",
                               33),
          "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 9\n" +
              std::string("\x02\x02\x00\x09\x89\x80\x89\x81\x89\x82\x89\x83", 12)};
}

bool try_input(std::string_view input) {
  // A picture may be as large as its maker likes: that is bounded here, as memory is.
  const core::ImageLimits limits{4096, size_t{1} << 20U};
  bool taken = false;
  for (const char* name : {"a.png", "a.tga"}) {  // TGA is the one that is told by its name
    taken |= core::read_image(exact_bytes(input), name, core::ColorSpace::automatic, limits).ok();
  }
  return taken;
}

}  // namespace hyades::fuzz
