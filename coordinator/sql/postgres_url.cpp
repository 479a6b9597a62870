#include "coordinator/sql/postgres_url.h"

#include <libpq-fe.h>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace hyades::coordinator {
namespace {

struct FreeOptions {
  void operator()(PQconninfoOption* options) const { PQconninfoFree(options); }
};

using UrlParts = std::map<std::string, std::string>;

std::string part(const UrlParts& parts, const std::string& name) {
  const auto found = parts.find(name);
  return found == parts.end() ? std::string() : found->second;
}

/// What stands between commas: one at least.
std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> pieces(1);
  for (const char c : list) {
    if (c == ',') {
      pieces.emplace_back();
    } else {
      pieces.back() += c;
    }
  }
  return pieces;
}

/// What a URL, or libpq's other form, says. Nothing where it makes no sense, or would not mean what
/// it looks like: a password with a '/' that is not written as %2F ends in the port and the name.
std::optional<UrlParts> parts_of(const std::string& url) {
  const std::unique_ptr<PQconninfoOption, FreeOptions> read(PQconninfoParse(url.c_str(), nullptr));
  if (!read) return std::nullopt;
  UrlParts parts;
  for (const PQconninfoOption* one = read.get(); one->keyword != nullptr; ++one) {
    if (one->val != nullptr) parts[one->keyword] = one->val;
  }
  if (part(parts, "port").find_first_not_of("0123456789,") != std::string::npos ||
      part(parts, "dbname").find('@') != std::string::npos) {
    return std::nullopt;
  }
  return parts;
}

}  // namespace

bool is_postgres_url(const std::string& text) {
  return text.starts_with("postgresql://") || text.starts_with("postgres://");
}

std::string without_password(const std::string& url) {
  const auto parts = parts_of(url);
  if (!parts) return "the database";
  std::string shown = "postgresql://";
  if (!part(*parts, "user").empty()) shown += part(*parts, "user") + "@";
  const std::string name = part(*parts, "host");
  const std::vector<std::string> hosts = split(name.empty() ? part(*parts, "hostaddr") : name);
  const std::vector<std::string> ports = split(part(*parts, "port"));
  for (size_t i = 0; i < hosts.size(); ++i) {
    shown += (i == 0 ? "" : ",") + hosts[i];
    const std::string& port = ports[ports.size() == hosts.size() ? i : 0];
    if (!port.empty()) shown += ":" + port;
  }
  if (!part(*parts, "dbname").empty()) shown += "/" + part(*parts, "dbname");
  return shown;
}

bool names_a_database(const std::string& url) { return parts_of(url).has_value(); }

}  // namespace hyades::coordinator
