#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/lua_script.h"

namespace hyades::core {
namespace {

using test::job_complaints;
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
           // Each item is looked up in a thousand tables, which Lua does not count.
           "local t = {} for i = 1, 1000 do t = setmetatable({}, {__index = t}) end "
           "table.move(t, 1, 100000, 1, {})",
           "local t = {} for i = 1, 1000 do t = setmetatable({}, {__newindex = t}) end "
           "table.move({}, 1, 100000, 1, t)",
           "local t = {} for i = 1, 1000 do t = setmetatable({}, {__index = t}) end "
           "string.gsub(('a'):rep(100000), '.', t)",
           "local t = {} for i = 1, 1000 do t = setmetatable({}, {__index = t}) end "
           "getmetatable('').__index = t table.move(setmetatable({}, {__index = ''}), 1, 100000, "
           "1, {})",
           // So is what stands for a match, and what texts have between zeros.
           "string.gsub(('a'):rep(100000), '', ('%0'):rep(1000))",
           "local t, s = {}, ('\\0'):rep(10000) for i = 1, 200 do t[i] = s end table.sort(t)",
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

TEST(LuaSandbox, WhatIsReturnedNamesFilesOfTheFolderAlone) {
  const auto returns = [](const std::string& sections) {
    MemoryAssets files;
    files.add("in/s.lua", "return {" + sections + "}");
    files.add("x.png", "a picture");
    files.add("in/more.yaml", "textures: {t: {type: image, file: ../x.png}}\n");
    files.add("in/a.lua", "return {textures = {t = {type = 'image', like = 'u'}}}");
    files.add("in/b.lua", "return {textures = {u = {file = '../x.png'}}}");
    return job_complaints("include: in/s.lua\n", std::move(files));
  };
  const char* const leads_out = "in/s.lua:1: ";
  for (const char* sections : {
           "textures = {t = {type = 'image', file = '../x.png'}}",
           "textures = {t = {type = 'image', file = 'a/../../x.png'}}",
           "environment = {image = '../x.png'}",
           "objects = {o = {mesh = '../x.png'}}",
           "objects = {o = {group = {objects = {p = {mesh = '../x.png'}}}}}",
           "groups = {g = {objects = {p = {mesh = '../x.png'}}}}",
           "objects = {o = {gltf = '../x.glb'}}",
           "objects = {o = {group = {objects = {p = {pbrt = '../x.pbrt'}}}}}",
           "media = {file = '../x.yaml'}",
           "media = {file = {'in.yaml', '../x.yaml'}}",
           "include = '../x.yaml'",
           "include = {'../x.yaml'}",
           "include = {lua = '../x.lua'}",
           "color = {config = '../c.ocio'}",
       }) {
    EXPECT_THAT(returns(sections),
                AllOf(HasSubstr(leads_out), HasSubstr("leads out of the folder")))
        << sections;
  }
  EXPECT_THAT(returns("textures = {t = {type = 'image', file = '/etc/x.png'}}"),
              HasSubstr("in/s.lua:1: file of texture 't': '/etc/x.png' is an absolute path"));
  EXPECT_THAT(
      returns("include = 'more.yaml'"),
      HasSubstr("in/more.yaml:1:35: file of texture 't': '../x.png' leads out of the folder"));
  EXPECT_THAT(returns("include = {'a.lua', 'b.lua'}"),
              HasSubstr("in/b.lua:1: file of texture 't': '../x.png' leads out of the folder"));
}

TEST(LuaSandbox, ItBringsNoColourConfiguration) {
  MemoryAssets files;
  files.add("in/c.ocio", "- !<FileTransform> {src: ../x.lut}\n- !<FileTransform> {src: y.lut}\n");
  files.add("x.lut", "a table");
  files.add("in/y.lut", "a table");
  files.add("in/s.lua", "return {color = {config = 'c.ocio'}}");
  files.add("in/c.yaml", "color: {config: c.ocio}\n");
  files.add("in/by_include.lua", "return {include = 'c.yaml'}");
  Job read;
  EXPECT_EQ(job_complaints("color: {config: in/c.ocio}\n", files, &read), "");
  ASSERT_TRUE(read.color);
  EXPECT_EQ(read.color->files, (std::vector<std::string>{"x.lut", "in/y.lut"}));
  // OpenColorIO opens what it finds named there, such as /dev/zero.
  EXPECT_THAT(job_complaints("include: in/s.lua\n", files),
              HasSubstr("is named by the script in/s.lua, expected it in the job"));
  EXPECT_THAT(job_complaints("include: in/by_include.lua\n", files),
              HasSubstr("is named by the script in/by_include.lua"));
}

TEST(LuaSandbox, FilesOfMediaAreReadByItsWord) {
  MemoryAssets files;
  files.add("x.nvdb", "a volume");
  files.add("in/m.yaml", "media:\n  smoke: {scattering: 1, density: {vdb: ../x.nvdb}}\n");
  files.add("in/s.lua", "return {media = {file = 'm.yaml'}}");
  files.add("in/more.yaml", "media: {file: m.yaml}\n");
  files.add("in/by_include.lua", "return {include = 'more.yaml'}");
  const char* const leads_out = "'../x.nvdb' leads out of the folder";
  EXPECT_THAT(job_complaints("include: in/s.lua\n", files), HasSubstr(leads_out));
  EXPECT_THAT(job_complaints("include: in/by_include.lua\n", files), HasSubstr(leads_out));
  EXPECT_THAT(job_complaints("media: {file: in/m.yaml}\n", files), Not(HasSubstr(leads_out)))
      << "a job may";
}

TEST(LuaSandbox, FilesOfMediaAreNoScenes) {
  MemoryAssets files;
  files.add("in/m.lua", "error('it ran')");
  files.add("in/s.lua", "return {media = {file = 'm.lua'}}");
  files.add("in/d.lua", "return {media = {file = 'm.lua,fps=24.yaml'}}");
  files.add("in/detour.lua", "return {media = {file = 'm.lua,prefix=a/%/../b.yaml'}}");
  for (const char* job : {"include: in/s.lua\n", "include: in/d.lua\n", "media: {file: in/m.lua}\n",
                          "include: in/detour.lua\n", "media: {file: in/m.gltf}\n"}) {
    EXPECT_THAT(job_complaints(job, files),
                AllOf(HasSubstr("file of media"), HasSubstr("expected a file of media"),
                      Not(HasSubstr("it ran"))))
        << job;
  }
}

/// Only what is included, once for each time: a picture of that name is none.
TEST(LuaSandbox, NamesOfPicturesRunNothing) {
  MemoryAssets files;
  files.add("in/s.lua", "error('it ran')");
  files.add("in/t.lua",
            "return {textures = {t = {type = 'image', file = 's.lua,fps=0,set.a=1.yaml'}}}");
  for (const char* job : {"textures: {t: {type: image, file: 'in/s.lua,fps=0,set.a=1.yaml'}}\n",
                          "include: in/t.lua\n", "include: 'in/s.lua,fps=0.yaml'\n"}) {
    EXPECT_THAT(job_complaints(job, files),
                AllOf(HasSubstr("no such file"), Not(HasSubstr("it ran"))))
        << job;
  }
}

/// Keys that are spread out in a table of 2^17, and all collide in one of twice the size: filling
/// that takes a minute within one instruction.
TEST(LuaSandbox, WhatNothingInterruptsEndsTheProgram) {
  lua::Limits limits;
  limits.seconds = 0.1;
  limits.overtime = 0.2;
  EXPECT_EXIT((void)run_lua("local n, t = 1 << 17, {} local m = 2 * n - 1 "
                            "for i = 1, n + 1 do t[i * m] = true end return {}",
                            {}, limits),
              testing::ExitedWithCode(2),
              "a/scene.lua: the script takes more than 0.10 s of processor time");
}

TEST(LuaSandbox, WhatFilesOfMediaHoldCounts) {
  MemoryAssets files;
  std::string names;
  for (const std::string name : {"a", "b", "c", "d"}) {
    std::string many = name + ": {absorption: [";
    for (int i = 0; i < 900'000; ++i) many += "1,";
    files.add(name + ".yaml", many + "]}\n");
    names += name + ".yaml, ";
  }
  EXPECT_THAT(job_complaints("media: {file: [" + names + "]}\n", files),
              HasSubstr("the included files have more than 2097152 values in all"));
}

/// What a script makes is kept until the job is read.
TEST(LuaSandbox, NoneRunsWhereThereIsTooMuchAlready) {
  MemoryAssets files;
  std::string includes;
  for (const std::string name : {"a", "b", "c"}) {
    std::string many = name + ": [";
    for (int i = 0; i < 900'000; ++i) many += "1,";
    files.add(name + ".yaml", many + "]\n");
    includes += name + ".yaml, ";
  }
  files.add("s.lua", "error('it ran')");
  EXPECT_THAT(job_complaints("include: [" + includes + "s.lua]\n", files),
              AllOf(HasSubstr("the included files have more than 2097152 values in all"),
                    Not(HasSubstr("it ran"))));
  EXPECT_THAT(job_complaints("include: [a.yaml, s.lua]\n", files), HasSubstr("it ran"));
}

TEST(LuaSandbox, ATextThatIsReturnedOftenCountsEachTime) {
  EXPECT_THAT(attack("local s = ('x'):rep(1000000) local t = {} for i = 1, 100 do t[i] = s end "
                     "do return {t = t} end"),
              HasSubstr("t[34] lies beyond 32.0 MiB of text, which is what a job may have"));
}

TEST(LuaSandbox, WhatIsMadeBesideTheScriptCounts) {
  lua::Limits limits = small_limits();
  limits.steps = lua::Limits().steps;
  const auto run = [&](const std::string& script) { return run_lua(script, {}, limits).error; };
  // One table of 16 bytes an item, which is 48 a copy and as much in the file.
  EXPECT_THAT(run("local c = {} local t = {} for i = 1, 500000 do t[i] = c end places(t)"),
              HasSubstr("the script takes more than 32.0 MiB of memory"));
  EXPECT_THAT(run("for k = 1, 100 do local t = {} for i = 1, 20000 do t[i] = {at = {k, i, 0}} end "
                  "places(t) end"),
              HasSubstr("more than 32.0 MiB of places in all"));
  EXPECT_THAT(run("local t = {} for i = 1, 500000 do t[i] = i end pairs(t)"),
              HasSubstr("the script takes more than 32.0 MiB of memory"));
}

TEST(LuaSandbox, TimeThatFewInstructionsTakeCounts) {
  lua::Limits limits;
  limits.seconds = 0.2;
  // Fewer instructions than lie between two looks at the clock: all the time is in Lua's library.
  for (const char* script : {
           "for i = 1, 100 do local s = ('x'):rep(15000000 + i) end",
           "local s = ('a'):rep(10000) for i = 1, 100 do s:find('a*b') end",
       }) {
    EXPECT_THAT(run_lua(script, {}, limits).error,
                HasSubstr("takes more than 0.20 s of processor time"))
        << script;
  }
  EXPECT_THAT(run_lua("table.sort({3, 1, 2}, rawequal)").error,
              HasSubstr("a comparison that is a built-in function, expected one of Lua"));
}

TEST(LuaSandbox, NothingThatItSaysSteersATerminal) {
  for (const char* script : {
           "error('\\27[31m')",
           "param('\\27[31m', 1)",
           "do return {['\\27[31m'] = print} end",
           "do return {1, ['\\27[31m'] = 1} end",
           "include('\\xC2\\x9B31m.lua')",
           "do return {v = {[true] = 1}} end",
       }) {
    const std::string said = attack(script);
    EXPECT_THAT(said, Not(HasSubstr("\x1b"))) << script;
    EXPECT_THAT(said, Not(HasSubstr("\xC2\x9B"))) << script;
    EXPECT_NE(said, "") << script;
  }
  EXPECT_THAT(run_lua("x = \x1b[31m").error, AllOf(Not(HasSubstr("\x1b")), Not(StartsWith("ERR"))));
  const std::string parameters =
      run_lua("param('n', '\\27[31m', '\\27[32m') return {}", {{"m", "1"}}).error;
  EXPECT_THAT(parameters, AllOf(HasSubstr("n = \"?[31m\"  (?[32m)"), Not(HasSubstr("\x1b"))));
}

TEST(LuaSandbox, WhatFramesDifferInCountsByItsSize) {
  MemoryAssets files;
  files.add("s.lua", "return {frames = '1-9999', name = ('x'):rep(1000000) .. frame()}");
  EXPECT_THAT(job_complaints("include: s.lua\nframes: 1-9999\n", files),
              HasSubstr("its frames differ in more than 1048576 values"));
  files.add("s.lua", "return {frames = '1-9999', [('x'):rep(1000000) .. frame()] = 1}");
  EXPECT_THAT(job_complaints("include: s.lua\nframes: 1-9999\n", files),
              HasSubstr("its frames differ in more than 1048576 values"));
}

TEST(LuaSandbox, WhatItPrintsIsBounded) {
  EXPECT_THAT(attack("print(('x'):rep(2000000))"), HasSubstr("a line of more than 1048576 bytes"));
  EXPECT_THAT(attack("local s = ('x'):rep(1000000) print(s, s, s)"),
              HasSubstr("a line of more than 1048576 bytes"));
}

TEST(LuaSandbox, FilesThatAreNoLuaLeaveNothing) {
  MemoryAssets files;
  files.add("a/bad.lua", "this is no Lua");
  files.add("a/raises.lua", "error('no')");
  EXPECT_THAT(run_lua("for i = 1, 100 do pcall(include, 'raises.lua') end\n"
                      "include('raises.lua')",
                      {}, {}, files)
                  .error,
              AllOf(HasSubstr("a/raises.lua:1: no"), Not(HasSubstr("includes itself"))));
  EXPECT_THAT(
      run_lua("for i = 1, 100 do pcall(include, 'bad.lua') end\nerror('done')", {}, {}, files)
          .error,
      HasSubstr("a/scene.lua:2: done"));
}

TEST(LuaSandbox, SortingLongTextsCostsTheirLength) {
  EXPECT_THAT(attack("local s = ('x'):rep(1000000) local t = {} for i = 1, 100 do t[i] = s end "
                     "table.sort(t)"),
              HasSubstr("takes more than 5,000,000 steps"));
  EXPECT_THAT(attack("string.find(('a'):rep(30000), '[' .. ('b'):rep(100000) .. ']*c')"),
              HasSubstr("this pattern may take too long"));
}

TEST(LuaSandbox, ParametersAreShort) {
  EXPECT_THAT(run_lua("param('n', ('x'):rep(1001)) return {}").error,
              HasSubstr("the default of parameter n is a text of 1001 B"));
  EXPECT_THAT(run_lua("param('n', 1, ('x'):rep(1001)) return {}").error,
              HasSubstr("the explanation of parameter n is a text of 1001 B"));
  EXPECT_THAT(run_lua("for i = 1, 1001 do param('n' .. i, 1) end return {}").error,
              HasSubstr("more than 1000 parameters"));
}

TEST(LuaSandbox, LimitsAreNotCaught) {
  const char* const too_long = "takes more than 5,000,000 steps";
  for (const char* script : {
           "while true do pcall(function() while true do end end) end",
           "while true do xpcall(function() while true do end end, function(e) return e end) end",
           "xpcall(function() while true do end end, function() while true do end end)",
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
  EXPECT_THAT(attack("for _ in string.gmatch(('^'):rep(40000), '^.*b') do end"), HasSubstr(refused))
      << "an anchor is a letter there";
  EXPECT_THAT(attack("string.find(('a'):rep(400000), '^(.*)%1b')"), HasSubstr(refused));
  EXPECT_THAT(attack("string.find(('a'):rep(2000000), ('a'):rep(1000000) .. 'b', 1, true)"),
              HasSubstr("takes more than 5,000,000 steps"));
  EXPECT_EQ(lua_value("v = ('say \"a\" now'):match('([\"\\'])(.-)%1')"), "v: \"\\\"\"\n");
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
