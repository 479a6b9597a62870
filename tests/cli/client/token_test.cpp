// Tokens that are made in a folder, without its coordinator.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coordinator/access/audit_log.h"
#include "coordinator/job_store/job_store.h"
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

TEST(TokenCommand, WhatIsDoneToAFolderIsInItsAuditLog) {
  const TempFolder folder;
  const std::string data = folder.path().string();
  ASSERT_EQ(run(token_command, {"create", "--data", data, "--role", "admin", "--name", "ada",
                                "--output", folder.file("ada")})
                .status,
            0);
  std::string id;
  {
    const auto store = coordinator::open_sqlite_job_store(folder.file("state.db"));
    ASSERT_TRUE(store.ok());
    const auto rows = (*store)->tokens();
    ASSERT_TRUE(rows.ok());
    ASSERT_EQ(rows->size(), 1U);
    id = rows->front().id;
  }
  ASSERT_EQ(run(token_command, {"revoke", "--data", data, id}).status, 0);
  EXPECT_NE(run(token_command, {"revoke", "--data", data, "00000000"}).status, 0);
  const auto log = coordinator::AuditLog::open({.folder = data});
  ASSERT_TRUE(log.ok());
  auto reader = (*log)->read();
  for (const std::string deed : {"token.create", "token.revoke"}) {
    const auto entry = reader.next();
    ASSERT_TRUE(entry) << deed;
    EXPECT_EQ(entry->deed(), deed);
    EXPECT_EQ(entry->target(), id);
    EXPECT_EQ(entry->token_id(), coordinator::kByFolder);
    EXPECT_FALSE(entry->name().empty());
    EXPECT_EQ(entry->result(), "ok");
  }
  EXPECT_FALSE(reader.next()) << "nothing was done to what is not there";
}

}  // namespace
}  // namespace hyades::cli
