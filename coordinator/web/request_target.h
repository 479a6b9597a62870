#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hyades::coordinator {

/// What a request's target ("/api/v1/jobs?limit=3") asks for.
struct Target {
  std::vector<std::string> path;             ///< {"api", "v1", "jobs"}
  std::map<std::string, std::string> query;  ///< of a name given twice the last one
};

/// Takes a target apart and decodes it. Nothing where `text` is none: it does not begin with '/',
/// an escape (%41) is none, or a part of the path is "." or ".." or holds a zero byte. Empty parts
/// of the path are left out; an escaped slash does not divide it (RFC 3986).
std::optional<Target> parse_target(std::string_view text);

}  // namespace hyades::coordinator
