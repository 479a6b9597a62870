#pragma once

#include <cstdint>
#include <string>

#include "coordinator/access/authority.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// How long the token holds that a coordinator makes by itself: long enough to make one's own with
/// it. It lies in a file, where whoever reads the folder finds it.
inline constexpr int64_t kFirstAdminLifetimeMs = int64_t{30} * 24 * 3600 * 1000;

/// Makes an admin's token and puts it into FOLDER/admin-token, over one that lies there; what is
/// stored of it. For a coordinator of which no admin's token is in use (Authority::has_admin). The
/// audit log tells of it.
core::Result<StoredToken> make_first_admin(Authority& authority, const std::string& folder);

}  // namespace hyades::coordinator
