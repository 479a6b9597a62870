#include "coordinator/access/audit_chain.h"

#include <utility>

#include "core/base/hash.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

template <class Number>
Number number_in(const farm::Json& line, const char* name) {
  const auto found = line.find(name);
  return found != line.end() && found->is_number_integer() ? found->get<Number>() : Number{};
}

std::string text_in(const farm::Json& line, const char* name) {
  const auto found = line.find(name);
  return found != line.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::string audit_line(const v1::AuditEntry& entry) {
  farm::Json line = farm::to_json(entry);
  line.erase("log");
  return line.dump(-1, ' ', false, farm::Json::error_handler_t::replace);
}

std::optional<v1::AuditEntry> read_audit_line(const std::string& text) {
  const farm::Json line = farm::Json::parse(text, nullptr, false);
  if (!line.is_object() || text_in(line, "deed").empty()) return std::nullopt;
  v1::AuditEntry entry;
  entry.set_time_ms(number_in<int64_t>(line, "time_ms"));
  entry.set_token_id(text_in(line, "token_id"));
  entry.set_name(text_in(line, "name"));
  entry.set_role(farm::role_of(text_in(line, "role")).value_or(v1::ROLE_UNSPECIFIED));
  entry.set_address(text_in(line, "address"));
  entry.set_deed(text_in(line, "deed"));
  entry.set_target(text_in(line, "target"));
  entry.set_result(text_in(line, "result"));
  entry.set_detail(text_in(line, "detail"));
  entry.set_times(number_in<uint64_t>(line, "times"));
  entry.set_previous(text_in(line, "previous"));
  return entry;
}

std::string audit_digest(const v1::AuditEntry& entry) {
  return core::to_hex(core::sha256(audit_line(entry)));
}

std::string AuditChains::add(const v1::AuditEntry& entry) {
  // Whoever is asked for the logs may be hostile, and name others without end.
  const auto found = ends_.find(entry.log());
  if (found == ends_.end()) return "is of a log that there is not";
  End& end = found->second;
  const bool first = end.entries++ == 0;
  const bool bare = entry.previous().empty();
  if (bare) ++end.bare;
  const bool chained = std::exchange(end.chained, !bare);
  const std::string before = std::exchange(end.last, audit_digest(entry));
  if (first) {
    end.first = entry.previous();
    return {};
  }
  // Entries of before there were chains hold nothing.
  if (bare) return chained ? "does not tell what came before it" : "";
  return entry.previous() == before ? "" : "does not follow on the one before it";
}

}  // namespace hyades::coordinator
