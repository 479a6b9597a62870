#pragma once

#include <string>
#include <string_view>

namespace hyades::coordinator {

/// The bytes packed as gzip (RFC 1952), as short as zlib makes them; empty where it cannot.
std::string gzip(std::string_view bytes);

/// Whether a header Accept-Encoding takes gzip: it is named, or "*" is, and not with q=0.
bool takes_gzip(std::string_view header);

}  // namespace hyades::coordinator
