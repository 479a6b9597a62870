// The token that a coordinator makes by itself.
#include "coordinator/access/first_admin.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "coordinator/access/token.h"
#include "farm/small_file.h"
#include "farm/token_term.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

TEST(FirstAdmin, ItsTokenEndsAndItIsToldThatItWasMade) {
  const test::TempFolder folder;
  auto store = open_sqlite_job_store(folder.file("state.db"));
  ASSERT_TRUE(store.ok());
  auto authority = Authority::open(**store, {.audit_folder = folder.path().string()});
  ASSERT_TRUE(authority.ok());
  const auto made = make_first_admin(**authority, folder.path().string());
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_EQ(made->role, v1::ROLE_ADMIN);
  EXPECT_EQ(made->expires_ms - made->created_ms, int64_t{30} * 24 * 3600 * 1000);
  const int64_t day = int64_t{24} * 3600 * 1000;
  EXPECT_FALSE(farm::expiry_warning(farm::term_of(made->created_ms, made->expires_ms),
                                    made->expires_ms - 3 * day)
                   .empty())
      << "who uses it hears of it before it ends";
  const auto file = farm::read_small_file(folder.file("admin-token"));
  ASSERT_TRUE(file.ok());
  Caller caller;
  const std::string shown = "Bearer " + file->substr(0, file->find('\n'));
  EXPECT_TRUE((*authority)->admit(shown, caller).ok());
  EXPECT_EQ(caller.token_id, made->id);
  const auto mode = std::filesystem::status(folder.file("admin-token")).permissions();
  EXPECT_EQ(mode, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  AuditLog& log = *(*authority)->audit();
  log.flush();
  auto reader = log.read();
  const auto entry = reader.next();
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->deed(), "token.create");
  EXPECT_EQ(entry->target(), made->id);
  EXPECT_EQ(entry->token_id(), kByItself);
  EXPECT_EQ(entry->result(), "ok");
  EXPECT_FALSE(reader.next());
}

TEST(FirstAdmin, ATokenThatCannotBeHandedOverIsRevoked) {
  const test::TempFolder folder;
  auto store = open_sqlite_job_store(folder.file("state.db"));
  ASSERT_TRUE(store.ok());
  auto authority = Authority::open(**store, {.audit_folder = folder.path().string()});
  ASSERT_TRUE(authority.ok());
  std::filesystem::create_directories(folder.file("admin-token/in the way"));
  EXPECT_FALSE(make_first_admin(**authority, folder.path().string()).ok());
  EXPECT_FALSE((*authority)->has_admin());
  AuditLog& log = *(*authority)->audit();
  log.flush();
  auto reader = log.read();
  (void)reader.next();
  const auto entry = reader.next();
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->deed(), "token.revoke");
}

}  // namespace
}  // namespace hyades::coordinator
