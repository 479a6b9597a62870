#include "core/base/own_environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace hyades::core {
namespace {

TEST(OwnEnvironment, HoldsNoSecrets) {
  ::setenv("HYADES_TOKEN", "hyades-secret", 1);
  ::setenv("AWS_SECRET_ACCESS_KEY", "secret", 1);
  ::setenv("LC_ALL", "C.UTF-8", 1);
  const std::vector<std::string> variables = own_environment();
  for (const std::string& variable : variables) {
    EXPECT_EQ(variable.find("secret"), std::string::npos) << variable;
  }
  EXPECT_NE(std::find(variables.begin(), variables.end(), "LC_ALL=C.UTF-8"), variables.end());
  for (const char* name : {"HYADES_TOKEN", "AWS_SECRET_ACCESS_KEY", "LC_ALL"}) ::unsetenv(name);
}

TEST(OwnEnvironment, IsPassedOnAsExecTakesIt) {
  std::vector<std::string> strings = {"A=1", "B=2"};
  const std::vector<char*> pointers = for_exec(strings);
  ASSERT_EQ(pointers.size(), 3U);
  EXPECT_STREQ(pointers[1], "B=2");
  EXPECT_EQ(pointers[2], nullptr);
}

}  // namespace
}  // namespace hyades::core
