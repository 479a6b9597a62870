#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "hyades/v1/admin.pb.h"

namespace hyades::coordinator {

// The lines of the audit log. Each entry holds the digest of the one before it in its log
// (AuditEntry::previous). Whoever changes one, leaves one out or puts one in between has to write
// all that follow anew. Then the last digest is another than anybody has noted.

/// The entry as it stands in its file, without an end of line; where it is read from
/// (AuditEntry::log) does not.
std::string audit_line(const v1::AuditEntry& entry);
/// The entry of a line; nothing where it is none of ours.
std::optional<v1::AuditEntry> read_audit_line(const std::string& line);
/// The SHA-256 of the entry's line, in hexadecimal: what the next one holds.
std::string audit_digest(const v1::AuditEntry& entry);

/// Follows the chains of a farm's logs, entry by entry, the oldest first.
class AuditChains {
 public:
  /// What is known of one log.
  struct End {
    uint64_t entries = 0;
    uint64_t bare = 0;     ///< of them, that hold no digest
    bool chained = false;  ///< whether the last entry holds a digest
    std::string first;     ///< the digest that its first entry holds; empty: the log begins there
    std::string last;      ///< of its last entry, to be noted
  };

  /// Empty where the entry is one of a log that there is, and follows on the one before it; else
  /// what is wrong, in words.
  std::string add(const v1::AuditEntry& entry);

  /// By AuditEntry::log: all logs that there are, also those that no entry was of.
  const std::map<std::string, End>& ends() const { return ends_; }

 private:
  std::map<std::string, End> ends_{{"audit", {}}, {"refusals", {}}, {"uploads", {}}};
};

}  // namespace hyades::coordinator
