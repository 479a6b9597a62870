#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/web/exchange.h"
#include "core/base/bytes.h"

struct archive;

namespace hyades::coordinator {

/// Makes a .zip of files while it is sent. They are stored as they are (pictures do not shrink), in
/// any number and size (zip64).
class ZipSource final : public BodySource {
 public:
  struct File {
    std::string name;  ///< in the archive
    std::string path;  ///< on disk
    uint64_t size = 0;
  };
  explicit ZipSource(std::vector<File> files);
  ~ZipSource() override;

  std::optional<std::string> next() override;
  std::optional<uint64_t> size() const override { return std::nullopt; }

 private:
  /// False where it cannot go on: a file is gone, say.
  bool step();

  std::vector<File> files_;
  size_t file_ = 0;
  core::Bytes bytes_;  ///< of the file that is being added
  uint64_t at_ = 0;
  bool in_file_ = false;
  bool over_ = false;
  std::string made_;
  archive* archive_ = nullptr;
};

}  // namespace hyades::coordinator
