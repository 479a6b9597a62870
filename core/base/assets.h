#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"

namespace hyades::core {

/// The one door through which every loader opens files, so that a dry run finds all assets of a job
/// and a worker can serve them by hash without a file system. Thread-safe.
class AssetResolver {
 public:
  virtual ~AssetResolver() = default;

  /// The bytes behind `reference`. A relative reference is relative to the folder of the job, or,
  /// where `from` is not empty, to the folder of asset `from` (an .mtl beside its .obj, say).
  /// Errors name the reference and what was wrong with it.
  virtual Result<Bytes> open(const std::string& reference, const std::string& from = {}) = 0;

  /// What `include` and objects bring of a scene or script: importers make such documents when they
  /// are opened so, and by no other name that a job or scene has for a file. open() gives those
  /// that were opened here before.
  virtual Result<Bytes> open_document(const std::string& reference, const std::string& from = {}) {
    return open(reference, from);
  }

  /// Whether there is such an asset (which may fail to open all the same). Nobody counts that as
  /// opening it.
  virtual bool exists(const std::string& reference) { return open(reference).ok(); }

  /// Whether `scene`, which somebody else may have written, may name `file`; both as
  /// resolve_reference() gives them. The error says where it leads. Who opens files that others
  /// have sent has none to guard.
  virtual Status may_name(const std::string& scene, const std::string& file);
};

/// Bytes of the longest name of a file that any system opens.
inline constexpr size_t kLongestFileName = 4096;

/// What `reference` means when asset `from` names it: a path relative to the job's folder (or an
/// absolute one), "." and ".." folded away. The names of AssetRecord, and what to pass as `from`
/// for assets that the asset names in its turn.
std::string resolve_reference(const std::string& reference, const std::string& from = {});

/// The bytes of a regular file, mapped. Folders, pipes, sockets and devices are refused without
/// blocking; errors do not repeat the name. The file must not shrink while it is in use.
Result<Bytes> map_file(const std::string& path);

/// Resolver over the file system: references are relative to `folder`; files are mapped, not read.
/// Absolute references and references that leave `folder` through ".." are allowed (this is the
/// user's own machine); devices, sockets and folders are refused.
std::unique_ptr<AssetResolver> make_file_resolver(const std::string& folder);

/// One asset as a dry run saw it.
struct AssetRecord {
  std::string reference;  ///< as the job or a parent asset names it, resolved to its path
  std::string sha256;     ///< hex, of the bytes
  uint64_t size = 0;      ///< bytes
};

/// Wraps a resolver and records each distinct asset that is opened, in order of first opening.
class RecordingResolver : public AssetResolver {
 public:
  explicit RecordingResolver(AssetResolver& inner);
  ~RecordingResolver() override;
  Result<Bytes> open(const std::string& reference, const std::string& from = {}) override;
  Result<Bytes> open_document(const std::string& reference, const std::string& from = {}) override;
  bool exists(const std::string& reference) override;
  Status may_name(const std::string& scene, const std::string& file) override;
  std::vector<AssetRecord> records() const;

 private:
  Result<Bytes> record(const std::string& resolved, Result<Bytes> bytes);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hyades::core
