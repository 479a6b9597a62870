#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// What a backup's last file is called: the list of all others.
inline constexpr const char* kManifestName = "hyades-backup";

/// The files of a backup, by their paths below the data folder.
struct Manifest {
  struct File {
    uint64_t size = 0;
    std::string sha256;  ///< hexadecimal
    friend bool operator==(const File&, const File&) = default;
  };
  std::map<std::string, File> files;
};

/// "hyades backup 1", a line "SHA-256 SIZE PATH" for each file, and "end SHA-256" of all before it.
std::string write_manifest(const Manifest& manifest);
/// Reads what write_manifest writes; an error for anything else.
core::Result<Manifest> parse_manifest(const std::string& text);

/// Whether it is the name of a file of the audit log: audit.jsonl, audit.1.jsonl, ...; the same of
/// refusals and uploads.
bool is_audit_file(const std::string& name);

/// Whether a backup may hold a file of that path: one of a coordinator's own, which leads nowhere
/// else.
bool is_backup_path(const std::string& path);

}  // namespace hyades::coordinator
