#include "import/pbrt/read_scene_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "import/pbrt/directives.h"
#include "import/within_folder.h"

namespace hyades::core::pbrt {
namespace {

constexpr size_t kMostIncludes = 10'000;
constexpr size_t kDeepestInclude = 64;
constexpr uint64_t kMostText = uint64_t{8} << 30;

/// Reads files into one scene.
class TextReader : public Includer {
 public:
  explicit TextReader(const SceneFiles& files) : files_(files), directives_(scene_, *this) {}

  Result<ParsedScene> read() {
    const std::string main = files_.main();
    const size_t slash = main.rfind('/');
    if (Status s = read_file(slash == std::string::npos ? main : main.substr(slash + 1)); !s) {
      return s.error();
    }
    if (Status s = directives_.finish(); !s) return s.error().in(main);
    return std::move(scene_);
  }

  Status include(const std::string& reference, const Place& place) override {
    auto path = within_folder(reference);
    if (!path) return place.error(path.error().message);
    if (std::find(open_.begin(), open_.end(), *path) != open_.end()) {
      return place.error("'" + *path + "' includes itself");
    }
    if (open_.size() >= kDeepestInclude) {
      return place.error("files are included deeper than " + std::to_string(kDeepestInclude) +
                         " levels");
    }
    if (++includes_ > kMostIncludes) {
      return place.error("more than " + format_count(kMostIncludes) + " files are included");
    }
    Status s = read_file(*path);
    // An error that names no place yet is about opening the file.
    if (!s && !opened_) return place.error(s.error().message);
    return s;
  }

 private:
  Status read_file(const std::string& path) {
    opened_ = false;
    auto bytes = files_.open(path);
    if (!bytes) return bytes.error();
    opened_ = true;
    text_ += bytes->size();
    if (text_ > kMostText) {
      return Error{path + ": the scene's files have more than " + format_bytes(kMostText)};
    }
    if (known_.insert(path).second) scene_.bytes += bytes->size();
    open_.push_back(path);
    Tokenizer tokens(std::string_view(bytes->chars(), bytes->size()), path);
    Status s = directives_.read(tokens);
    open_.pop_back();
    return s;
  }

  const SceneFiles& files_;
  ParsedScene scene_;
  Directives directives_;
  std::vector<std::string> open_;  ///< files that are being read
  std::set<std::string> known_;    ///< all files
  size_t includes_ = 0;
  uint64_t text_ = 0;
  bool opened_ = false;
};

}  // namespace

Result<ParsedScene> read_scene_text(const SceneFiles& files) { return TextReader(files).read(); }

}  // namespace hyades::core::pbrt
