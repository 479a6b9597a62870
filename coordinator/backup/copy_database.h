#pragma once

#include <functional>
#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// Copies the job store `from`, which a coordinator may be writing, to the new file `to`, as it
/// stood at one moment. The coordinator keeps the database to itself (its log of changes has no
/// shared index), so what is copied are its files: the database, then its log, until a copy came
/// about during which neither was begun anew; SQLite joins and checks the two as after a crash.
/// `between` is called between the two files (tests). The error says what stood in the way.
core::Status copy_database(
    const std::string& from, const std::string& to, const std::function<void()>& between = [] {});

}  // namespace hyades::coordinator
