#include "coordinator/access/first_admin.h"

#include <unistd.h>

#include "farm/small_file.h"

namespace hyades::coordinator {

core::Result<StoredToken> make_first_admin(Authority& authority, const std::string& folder) {
  const std::string file = folder + "/admin-token";
  const auto note = [&](const std::string& action, const StoredToken& row,
                        const grpc::Status& result) {
    if (AuditLog* log = authority.audit()) {
      log->note({kByItself, {}, v1::ROLE_ADMIN, kThisMachine}, action, row.id, result,
                "no admin's token was in use: " + file);
    }
  };
  // One that lies there is of no use: no admin's token is.
  (void)::unlink(file.c_str());
  std::string text;
  StoredToken row;
  const grpc::Status made =
      authority.create("admin", v1::ROLE_ADMIN, kFirstAdminLifetimeMs, text, row);
  note("token.create", row, made);
  if (!made.ok()) return core::Error{made.error_message()};
  if (auto written = farm::write_secret(file, text + "\n"); !written) {
    note("token.revoke", row, authority.revoke(row.id, row));
    return written.error();
  }
  return row;
}

}  // namespace hyades::coordinator
