#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/lua_script.h"

namespace hyades::core {
namespace {

using test::lua_value;
using test::run_lua;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Small enough to be met within a second.
lua::Limits small_limits() {
  lua::Limits limits;
  limits.steps = 5'000'000;
  limits.memory = size_t{32} << 20;
  limits.text = size_t{4} << 20;
  return limits;
}

std::string attack(const std::string& script) {
  return run_lua(script + "\nreturn {ended = true}", {}, small_limits()).error;
}

TEST(LuaSandbox, NothingReachesTheMachine) {
  for (const char* name : {"io", "os", "package", "debug", "coroutine", "require", "dofile",
                           "loadfile", "load", "loadstring", "collectgarbage", "string.dump"}) {
    EXPECT_EQ(lua_value(std::string("v = ") + name + " == nil"), "v: true\n") << name;
  }
}

TEST(LuaSandbox, CompiledLuaIsRefused) {
  EXPECT_THAT(run_lua("\x1bLua\x54").error, HasSubstr("attempt to load a binary chunk"));
}

TEST(LuaSandbox, WhatDoesNotEndIsEnded) {
  const char* const too_long = "takes more than 5,000,000 steps";
  for (const char* script : {
           "while true do end",
           "local function f() return f() end f()",
           "for i = 1, math.huge do local t = {i} end",
           "table.move({}, 1, 10^15 // 1 | 0, 1)",
           "table.move({}, 1, 1000000000000000, 2)",
           "table.concat({}, '', 1, 1000000000)",
           "table.insert({}, math.mininteger, 1)",
           "string.rep('', 1000000000000000)",
           "local t = {} for i = 1, 100000 do t[i] = i end while true do next(t, 5) end",
           "local t = {} for i = 1, 100000 do t[i] = i end while true do pairs(t) end",
           "while true do local s = ('x'):rep(1000000) end",
           "while true do string.find(('x'):rep(100000), 'y', 1, true) end",
       }) {
    EXPECT_THAT(attack(script), AllOf(StartsWith("a/scene.lua:1: "), HasSubstr(too_long)))
        << script;
  }
}

TEST(LuaSandbox, WhatIsCopiedCounts) {
  lua::Limits limits = small_limits();
  limits.seconds = 10.0;  // twenty million steps that copy a text of a megabyte would take longer
  limits.steps = 20'000'000;
  EXPECT_THAT(
      run_lua("local s = ('x'):rep(1000000) while true do local t = s .. 'y' end", {}, limits)
          .error,
      HasSubstr("takes more than 20,000,000 steps"));
  limits.seconds = 0.2;
  limits.steps = lua::Limits().steps;
  EXPECT_THAT(run_lua("while true do end", {}, limits).error,
              HasSubstr("takes more than 0.20 s of processor time"));
}

TEST(LuaSandbox, LimitsAreNotCaught) {
  const char* const too_long = "takes more than 5,000,000 steps";
  for (const char* script : {
           "while true do pcall(function() while true do end end) end",
           "while true do xpcall(function() while true do end end, function(e) return e end) end",
           "pcall(function() while true do end end) v = 1",
           "setmetatable({}, {__index = function() while true do end end}).x = nil\n"
           "local t = setmetatable({}, {__index = function() while true do end end})\n"
           "pcall(function() return t.x end)",
           "table.sort({3, 2, 1, 5, 4}, function(a, b) while true do end end)",
           "local t <close> = setmetatable({}, {__close = function() while true do end end})",
           "tostring(setmetatable({}, {__tostring = function() while true do end end}))",
           "string.gsub('abc', '.', function() while true do end end)",
       }) {
    EXPECT_THAT(attack(script), HasSubstr(too_long)) << script;
  }
  const std::string memory = attack(
      "local ok = pcall(function() local t = {} for i = 1, 1e7 do t[i] = {i} end end) v = ok");
  EXPECT_THAT(memory, HasSubstr("takes more than 32.0 MiB of memory"));
}

TEST(LuaSandbox, MemoryIsBounded) {
  EXPECT_THAT(attack("local t = {}\nfor i = 1, 1e7 do\n  t[i] = {i}\nend"),
              HasSubstr("the script takes more than 32.0 MiB of memory"));
  lua::Limits many_steps = small_limits();
  many_steps.steps = lua::Limits().steps;
  const auto patient = [&](const std::string& script) {
    return run_lua(script, {}, many_steps).error;
  };
  EXPECT_THAT(patient("local s = ('a'):rep(1000000000)"), HasSubstr("32.0 MiB of memory"));
  EXPECT_THAT(attack("local s = 'a' while true do s = s .. s end"),
              AllOf(StartsWith("a/scene.lua:1: "), HasSubstr("a text of more than 4.0 MiB")));
  EXPECT_THAT(patient("local t = {} for i = 1, 60 do t[i] = ('a'):rep(1000000) .. i end"),
              HasSubstr("32.0 MiB of memory"));
}

TEST(LuaSandbox, PatternsThatWouldTryForEverAreRefused) {
  const char* const refused = "this pattern may take too long on a text of";
  EXPECT_THAT(attack("string.find(('a'):rep(100000), ('.-'):rep(50) .. 'b')"), HasSubstr(refused));
  EXPECT_THAT(attack("string.match(('a'):rep(3000), '.-.-.-b')"), HasSubstr(refused));
  EXPECT_THAT(attack("string.gsub(('a'):rep(100), ('a?'):rep(40) .. 'b', '')"), HasSubstr(refused));
  EXPECT_THAT(attack("for _ in string.gmatch(('a'):rep(3000), '.*.*.*b') do end"),
              HasSubstr(refused));
  EXPECT_THAT(attack("string.find(('('):rep(60000), '%b()%b()')"), HasSubstr(refused));
  EXPECT_THAT(attack("string.find(('a'):rep(40000), 'a*b')"), HasSubstr(refused))
      << "a search begins anywhere";
  EXPECT_EQ(lua_value("v = ('  a b  '):match('^%s*(.-)%s*$')"), "v: a b\n");
  EXPECT_EQ(lua_value("v = 0 for x in ('1 2 3'):gmatch('%d+') do v = v + x end"), "v: 6\n");
}

TEST(LuaSandbox, DeepThingsAreErrorsOfLua) {
  EXPECT_THAT(run_lua("local function f(n) return 1 + f(n + 1) end f(1)").error,
              HasSubstr("stack overflow"));
  EXPECT_THAT(attack("return " + std::string(100'000, '{')), HasSubstr("overflow"));
  EXPECT_THAT(attack("local t = {} for i = 1, 10000 do t = {t} end do return {v = t} end"),
              HasSubstr("lies deeper than 64 tables"));
  EXPECT_THAT(attack("local t = {} t.t = t do return t end"),
              HasSubstr("lies deeper than 64 tables (a table within itself?)"));
  EXPECT_THAT(attack("local t = {1, 2} for i = 1, 40 do t = {t, t} end do return {v = t} end"),
              HasSubstr("lies beyond 1048576 values and keys"));
  EXPECT_THAT(attack("table.unpack({}, 1, 1e7 // 1 | 0)"), HasSubstr("5,000,000 steps"));
  EXPECT_THAT(attack("table.unpack({}, 1, 2000000)"), HasSubstr("too many results to unpack"));
}

TEST(LuaSandbox, NoFinalizersNoWeakTablesNoLyingLengths) {
  EXPECT_THAT(attack("setmetatable({}, {__gc = function() while true do end end})"),
              HasSubstr("a metatable with __gc"));
  EXPECT_THAT(attack("setmetatable({}, {__mode = 'k'})"), HasSubstr("a metatable with __mode"));
  for (const char* call : {"insert(t, 1, 2)", "remove(t, 1)", "concat(t)", "unpack(t)", "sort(t)",
                           "move(t, 1, 2, 3)"}) {
    EXPECT_THAT(attack("local t = setmetatable({}, {__len = function() return 1e15 // 1 | 0 end}) "
                       "table." +
                       std::string(call)),
                HasSubstr("a table with __len, expected a plain list"))
        << call;
  }
}

TEST(LuaSandbox, ErrorsThatAreNoTextsAreTold) {
  EXPECT_THAT(attack("error({})"), StartsWith("an error that is a table, expected a text"));
  EXPECT_THAT(attack("error()"), HasSubstr("an error that is a nil"));
  EXPECT_THAT(attack("error(setmetatable({}, {__tostring = function() return 'mine' end}))"),
              HasSubstr("an error that is a table"));
  EXPECT_THAT(attack("error('\\27[31mred')"), Not(HasSubstr("\x1b")));
}

TEST(LuaSandbox, IncludedScriptsLieInTheFolder) {
  const auto includes = [](const std::string& name, MemoryAssets files = {}) {
    return run_lua("return include('" + name + "')", {}, {}, std::move(files)).error;
  };
  EXPECT_THAT(includes("../x.lua"), HasSubstr("'../x.lua' leads out of the folder"));
  EXPECT_THAT(includes("/etc/x.lua"), HasSubstr("is an absolute path"));
  EXPECT_THAT(includes("http://x.lua"), HasSubstr("is not a file"));
  EXPECT_THAT(includes("/etc/passwd"), HasSubstr("is an absolute path"));
  EXPECT_THAT(includes("notes.txt"), HasSubstr("'notes.txt', expected a script (.lua)"));
  EXPECT_THAT(includes("gone.lua"), AllOf(StartsWith("a/scene.lua:1: "), HasSubstr("gone.lua")));
  MemoryAssets loop;
  loop.add("a/b.lua", "return include('c.lua')");
  loop.add("a/c.lua", "return include('b.lua')");
  EXPECT_THAT(includes("b.lua", loop), HasSubstr("'b.lua' includes itself in the end"));
  MemoryAssets deep;
  for (int i = 0; i < 20; ++i) {
    deep.add("a/d" + std::to_string(i) + ".lua",
             "return include('d" + std::to_string(i + 1) + ".lua')");
  }
  EXPECT_THAT(includes("d0.lua", deep), HasSubstr("lies too deep, expected at most 16 levels"));
}

}  // namespace
}  // namespace hyades::core
