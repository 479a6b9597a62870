#pragma once

#include <string>

namespace hyades::coordinator {

/// Whether `text` is a URL of PostgreSQL.
bool is_postgres_url(const std::string& text);

/// User, hosts and name of the database that `url` (or libpq's other form) names, for messages;
/// "the database" where that makes no sense.
std::string without_password(const std::string& url);

/// Whether libpq can read it, and it means what it looks like.
bool names_a_database(const std::string& url);

}  // namespace hyades::coordinator
