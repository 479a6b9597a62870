#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/web/exchange.h"
#include "core/job/made_file.h"

struct archive;

namespace hyades::coordinator {

/// Makes a .zip of files while it is sent. They are stored as they are (pictures do not shrink), in
/// any number and size (zip64).
class ZipSource final : public BodySource {
 public:
  /// Of files in `folder`.
  explicit ZipSource(std::string folder);
  ~ZipSource() override;

  /// Adds a file by its path in the folder, by which it is called in the archive, too. Before the
  /// first piece is asked for.
  void add(std::string name, uint64_t size);

  std::optional<std::string> next() override;
  std::optional<uint64_t> size() const override { return std::nullopt; }
  uint64_t bytes_kept() const override { return bytes_kept_; }

 private:
  struct File {
    std::string name;
    uint64_t size = 0;
  };
  /// False where it cannot go on: a file is gone, say.
  bool step();

  const std::string folder_;
  std::vector<File> files_;
  uint64_t bytes_kept_ = 0;  ///< what is known of all files, here and for the archive's end
  size_t file_ = 0;
  core::MadeFile bytes_;  ///< of the file that is being added
  uint64_t at_ = 0;
  bool in_file_ = false;
  bool over_ = false;
  std::string made_;
  archive* archive_ = nullptr;
};

}  // namespace hyades::coordinator
