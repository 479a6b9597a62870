#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::farm {

/// The bytes of a file that a person has named: a token, a certificate. An error that names it
/// where it cannot be read or has more than 4 MiB.
core::Result<std::string> read_small_file(const std::string& path);

/// Makes a file that only its owner may read (0600): a token, a key. An error that names it where
/// it is there already or cannot be written; then nothing of it stays.
core::Status write_secret(const std::string& path, const std::string& text);

/// Writes a secret to a file that only its owner may read, in place of one that may be there:
/// whatever happens the old one or the new one is there, and the new one outlives a crash once this
/// returns without an error. On its way it is in PATH.new.
core::Status replace_secret(const std::string& path, const std::string& text);

}  // namespace hyades::farm
