#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "core/geometry/read_hair.h"
#include "core/geometry/read_places.h"
#include "import/scene_source.h"
#include "tests/import/lua_script.h"

namespace hyades::core {
namespace {

using test::job_complaints;
using test::lua_value;
using test::LuaSays;
using test::run_lua;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(LuaTree, TablesBecomeListsAndMaps) {
  EXPECT_EQ(run_lua("return {b = {1, 2.5, 'x'}, a = {y = true, x = false}, c = 3.0, d = {}}").yaml,
            "a: {x: false, y: true}\nb: [1, 2.5, x]\nc: 3\nd: {}\n");
  EXPECT_EQ(lua_value("v = {'1', 'true', '#d8c8a8', '3200K', '= 2 * t', 'a: b'}"),
            "v: [\"1\", \"true\", \"#d8c8a8\", 3200K, \"= 2 * t\", \"a: b\"]\n");
  EXPECT_EQ(lua_value("v = {keys = {[48] = 2, [1] = 1, [2.5] = {0, 1}}}"),
            "v:\n  keys: {1: 1, 2.5: [0, 1], 48: 2}\n");
  EXPECT_EQ(lua_value("v = {keys = {[1] = 1, [2] = 2}}"), "v:\n  keys: {1: 1, 2: 2}\n");
  EXPECT_EQ(lua_value("v = {0.1, 1/3, 1e-7, 100000000, 2^53, 0.1 + 0.2}"),
            "v: [0.1, 0.33333334, 1e-07, 100000000, 9007199254740992, 0.3]\n");
}

TEST(LuaTree, WhatIsNoTreeIsToldWithItsPlaceAndPath) {
  const auto error = [](const std::string& script) { return run_lua(script).error; };
  EXPECT_EQ(error("return {\n  objects = {\n    ball = {at = {0, print, 1}}}}"),
            "a/scene.lua:3: objects.ball.at[2] is a function, expected a number, a text, true, "
            "false or a table");
  EXPECT_EQ(error("local t = {\n1, 2, name = 3} return {film = t}"),
            "a/scene.lua:1: film has items and the key 'name', expected a list (1, 2, 3, ...) or a "
            "map of names");
  EXPECT_THAT(error("return {size = {[3] = 1}}"), HasSubstr("size has the key 3, expected a list"));
  EXPECT_THAT(error("return {[true] = 1}"), HasSubstr("has the key that is a boolean"));
  EXPECT_THAT(error("return {fov = 0/0}"), HasSubstr("fov is -nan, expected a finite number"));
  EXPECT_THAT(error("return {fov = math.huge}"), HasSubstr("fov is inf, expected a finite number"));
  EXPECT_THAT(error("x = 1"), HasSubstr("a/scene.lua: the script returns nothing, expected"));
  EXPECT_THAT(error("return 'x'"), HasSubstr("the script returns string, expected a table"));
}

TEST(LuaTree, MistakesInJobsNameTheLineWhereTheTableWasMade) {
  MemoryAssets files;
  files.add("in/town.lua",
            "local function house(x)\n  return {shape = 'box', colour = x}\nend\n"
            "return {\n  camera = {fov = 200},\n  objects = {a = house(1),\n"
            "    b = include('parts/roof.lua')}}\n");
  files.add("in/parts/roof.lua", "\n\nreturn {shape = 'cone'}\n");
  const std::string said = job_complaints("include: in/town.lua\n", files);
  EXPECT_THAT(said, HasSubstr("in/town.lua:2: ")) << said;
  EXPECT_THAT(said, HasSubstr("in/town.lua:5: fov is '200'")) << said;
  EXPECT_THAT(said, HasSubstr("in/parts/roof.lua:3: ")) << said;
}

TEST(LuaTree, FilesAreNamedFromTheScriptsFolder) {
  MemoryAssets files;
  files.add("in/wood.png", "picture");
  files.add("in/parts/p.lua", "return {type = 'image', file = 'wood.png'}");
  files.add("in/s.lua",
            "return {textures = {w = {type = 'image', file = 'wood.png'}, p = "
            "include('parts/p.lua')}}");
  EXPECT_EQ(job_complaints("include: in/s.lua\n", files), "");
  files.add("in/s.lua", "return {textures = {w = {type = 'image', file = 'gone.png'}}}");
  EXPECT_THAT(job_complaints("include: in/s.lua\n", files), HasSubstr("in/gone.png"));
}

TEST(LuaErrors, NameFileAndLineAndHaveATraceback) {
  const std::string said =
      run_lua("local function wall(x)\n  return x.size\nend\nlocal t = {wall(nil)}\nreturn t")
          .error;
  EXPECT_THAT(said, StartsWith("a/scene.lua:2: attempt to index a nil value (local 'x')\n"));
  EXPECT_THAT(said, AllOf(HasSubstr("stack traceback:"), HasSubstr("a/scene.lua:4: in main chunk")))
      << said;
  EXPECT_THAT(run_lua("return {").error, StartsWith("a/scene.lua:1: unexpected symbol near <eof>"));
  EXPECT_THAT(run_lua("\ntable.insert({}, 'x', 2)").error,
              StartsWith("a/scene.lua:2: bad argument #2 to 'insert'"));
  MemoryAssets files;
  files.add("a/b.lua", "\nlocal x = y.z");
  EXPECT_THAT(run_lua("return include('b.lua')", {}, {}, files).error,
              StartsWith("a/b.lua:2: attempt to index a nil value (global 'y')"));
  files.add("a/b.lua", "\nreturn }");
  EXPECT_THAT(run_lua("return include('b.lua')", {}, {}, files).error,
              HasSubstr("a/b.lua:2: unexpected symbol near '}'"));
}

TEST(LuaOrder, PairsAndNextGoInADefinedOrder) {
  EXPECT_EQ(lua_value("local f, t = {}, {}\nlocal x = {b = 1, a = 2, [3] = 3, [-1] = 4, [1.5] = 5, "
                      "[true] = 6, [false] = 7, [f] = 8, [t] = 9}\nv = {}\n"
                      "for k, w in pairs(x) do v[#v + 1] = w end"),
            "v: [4, 5, 3, 2, 1, 7, 6, 8, 9]\n");
  EXPECT_EQ(lua_value("local x = {c = 1, a = 2, b = 3}\nv = {}\nlocal k, w = next(x)\n"
                      "while k do v[#v + 1] = k k, w = next(x, k) end"),
            "v: [a, b, c]\n");
  EXPECT_EQ(lua_value("v = {next({})}"), "v: {}\n");
  EXPECT_EQ(lua_value("local x = {a = 1, b = 2, c = 3}\nv = {}\nfor k in pairs(x) do x.b = nil "
                      "v[#v + 1] = k end"),
            "v: [a, c]\n");
  EXPECT_THAT(lua_value("for k in pairs({[print] = 1}) do end"), HasSubstr("has an order"));
}

TEST(LuaOrder, NothingDiffersFromRunToRun) {
  EXPECT_EQ(lua_value("v = {tostring({}), tostring(print), string.format('%s', {})}"),
            "v: [table, function, table]\n");
  EXPECT_THAT(lua_value("v = string.format('%p', {})"), HasSubstr("%p in a format"));
  EXPECT_THAT(lua_value("v = math.random()"), HasSubstr("local rnd = random(seed)"));
  const std::string many =
      "local r = random(5)\nv = {}\nfor i = 1, 50 do v[i] = {r(), r(10), r(-3, 3), "
      "math.sin(i), math.exp(i), math.pow(i, 0.3)} end";
  EXPECT_EQ(lua_value(many), lua_value(many));
}

TEST(LuaOrder, RandomNumbersAreThoseOfTheirSeed) {
  EXPECT_EQ(lua_value("local r = random(1) v = {r(1000000), r(1000000), r(-5, 5), r()}"),
            lua_value("local r = random(1) v = {r(1000000), r(1000000), r(-5, 5), r()}"));
  EXPECT_NE(lua_value("v = random(1)()"), lua_value("v = random(2)()"));
  EXPECT_EQ(lua_value("local r = random(3)\nlocal n = {0, 0, 0, 0, 0, 0}\nlocal sum = 0\n"
                      "for i = 1, 60000 do local k = r(6) n[k] = n[k] + 1 sum = sum + r() end\n"
                      "v = {math.abs(sum / 60000 - 0.5) < 0.005}\n"
                      "for k = 1, 6 do v[k + 1] = math.abs(n[k] - 10000) < 400 end"),
            "v: [true, true, true, true, true, true, true]\n");
  EXPECT_THAT(lua_value("v = random(1)(3, 2)"), HasSubstr("bad argument #2"));
}

TEST(LuaMath, IsOursAndRounded) {
  EXPECT_EQ(lua_value("v = {math.sin(math.pi / 6), math.cos(0), math.log(8, 2), math.pow(-2, 3), "
                      "math.atan(1, 1), math.sqrt(2), 7 // 2, 2^0.5 > 1.41}"),
            "v: [0.5, 1, 3, -8, 0.7853982, 1.4142135, 3, true]\n");
}

TEST(LuaParameters, AreReadAsTheirDefaults) {
  const std::string script =
      "return {v = {param('n', 1), param('x', 0.5, 'how far'), param('s', 'red'), param('b', "
      "true)}}";
  EXPECT_EQ(run_lua(script).yaml, "v: [1, 0.5, red, true]\n");
  EXPECT_EQ(run_lua(script, {{"n", "7"}, {"x", "2"}, {"s", "12"}, {"b", "false"}}).yaml,
            "v: [7, 2, \"12\", false]\n");
  EXPECT_EQ(run_lua(script, {{"n", "7"}, {"n", "9007199254740993"}}).yaml,
            "v: [9007199254740993, 0.5, red, true]\n");
  EXPECT_THAT(run_lua(script, {{"n", "1.5"}}).error,
              StartsWith("a/scene.lua:1: parameter n is '1.5', expected a whole number (default: "
                         "1)"));
  EXPECT_THAT(run_lua(script, {{"x", "wide"}}).error,
              HasSubstr("expected a number (default: 0.5)"));
  EXPECT_THAT(run_lua(script, {{"x", "0x10"}}).error, HasSubstr("expected a number"));
  EXPECT_THAT(run_lua(script, {{"b", "1"}}).error, HasSubstr("expected true or false"));
  EXPECT_THAT(run_lua(script, {{"xx", "1"}}).error,
              AllOf(StartsWith("a/scene.lua: there is no parameter 'xx'"),
                    HasSubstr("\n  n = 1\n  x = 0.5  (how far)\n  s = \"red\"\n  b = true")));
  EXPECT_THAT(run_lua("return {}", {{"n", "1"}}).error,
              HasSubstr("no parameter 'n': the script has none"));
  EXPECT_THAT(run_lua("return {v = param('n', {})}").error,
              HasSubstr("the default of parameter n"));
  EXPECT_THAT(run_lua("return {v = {param('n', 1), param('n', 2)}}").error,
              HasSubstr("parameter n has the default 2 here and 1 elsewhere"));
}

TEST(LuaParameters, AJobSetsThem) {
  MemoryAssets files;
  files.add("s.lua",
            "local n = param('n', 1)\nlocal o = {}\nfor i = 1, n do o['ball_' .. i] = {shape = "
            "'sphere', radius = param('r', 1.5)} end\nreturn {objects = o}");
  Job job;
  EXPECT_EQ(job_complaints("include: {lua: s.lua, set: {n: 3}}\n", files, &job), "");
  EXPECT_EQ(job.objects.size(), 3U);
  EXPECT_EQ(job_complaints("include: [{lua: s.lua}]\n", files, &job), "");
  EXPECT_EQ(job.objects.size(), 1U);
  EXPECT_THAT(job_complaints("include: {lua: s.lua, set: {m: 3}}\n", files),
              AllOf(HasSubstr("job.yaml:2:16: include: s.lua: there is no parameter 'm'"),
                    HasSubstr("n = 1")));
  EXPECT_THAT(job_complaints("include: {lua: s.glb}\n", files),
              HasSubstr("lua is 's.glb', expected the name of a script (.lua)"));
  EXPECT_THAT(job_complaints("include: {lua: s.lua, sets: {n: 3}}\n", files),
              HasSubstr("unknown key 'sets' of include, did you mean 'set'?"));
  EXPECT_THAT(job_complaints("include: {lua: s.lua, set: {n: [1]}}\n", files),
              HasSubstr("parameter n is a list of 1, expected a number, a text, true or false"));
  EXPECT_THAT(job_complaints("include: {set: {n: 1}}\n", files),
              HasSubstr("include is a map, expected a file name, {lua: script.lua,"));
}

TEST(LuaFrames, WhatDiffersBecomesKeys) {
  MemoryAssets files;
  files.add("s.lua",
            "return {frames = {range = '1-3', fps = 2}, objects = {a = {shape = 'sphere', at = "
            "{time(), frame(), 0}, radius = 1}}}");
  ImportingResolver importing(files);
  const auto source = read_scene(importing.sources(), "s.lua");
  ASSERT_TRUE(source);
  SceneRequest request;
  request.fps = 0.0F;
  const auto own = (*source)->sections(request);
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_THAT(write_yaml(*own->sections),
              HasSubstr("at: {keys: {1: [0, 1, 0], 2: [0.5, 2, 0], 3: [1, 3, 0], 4: [1.5, 4, 0]}, "
                        "ease: linear}\n    radius: 1\n    shape: sphere\n"));
  request.fps = 10.0F;
  request.frames = "5";
  const auto of_job = (*source)->sections(request);
  ASSERT_TRUE(of_job);
  EXPECT_THAT(write_yaml(*of_job->sections), HasSubstr("keys: {5: [0.4, 5, 0], 6: [0.5, 6, 0]}"));
}

TEST(LuaFrames, AJobsFramesCount) {
  MemoryAssets files;
  files.add("s.lua",
            "return {frames = {range = '1-2', fps = 2}, objects = {a = {shape = 'sphere', radius = "
            "1 + time()}}}");
  Job job;
  EXPECT_EQ(job_complaints("include: s.lua\nframes: {range: 10-12, fps: 4}\n", files, &job), "");
  EXPECT_EQ(job.frames.last, 12);
  ASSERT_EQ(job.includes.size(), 1U);
  EXPECT_EQ(job.includes[0], "s.lua,fps=4,frames=10-12.yaml");
  ImportingResolver importing(files);
  const auto made = importing.open_document(job.includes[0]);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_THAT(std::string(made->chars(), made->size()),
              HasSubstr("radius: {keys: {10: 3.25, 11: 3.5, 12: 3.75, 13: 4}, ease: linear}"));
}

TEST(LuaFrames, WhatCannotChangeIsToldWithItsPath) {
  const auto said = [](const std::string& script) {
    MemoryAssets files;
    files.add("in/s.lua", script);
    return job_complaints("include: in/s.lua\nframes: 1-3\n", files);
  };
  EXPECT_THAT(said("local o = {a = {shape = 'sphere'}}\nif frame() == 2 then\n  o.b = {shape = "
                   "'box'}\nend\nreturn {objects = o}"),
              HasSubstr("in/s.lua:3: objects.b is there in frame 2 and not in frame 1"));
  EXPECT_THAT(
      said("return {objects = {a = {shape = frame() > 2 and 'box' or 'sphere'}}}"),
      HasSubstr("in/s.lua:1: objects.a.shape is the text \"sphere\" in frame 1 and the text "
                "\"box\" in frame 3, expected the same in every frame"));
  EXPECT_THAT(
      said("local t = {}\nfor i = 1, frame() do t[i] = {scale = 1} end\nreturn {objects = "
           "{a = {shape = 'box', transform = t}}}"),
      HasSubstr("objects.a.transform is a list of 1 in frame 1 and a list of 2 in frame 2"));
  MemoryAssets files;
  files.add("s.lua",
            "local t = {}\nfor i = 1, 1000 do t['b' .. i] = {shape = 'sphere', radius = i + "
            "frame(), material = ('m'):rep(6400) .. frame()} end\nreturn {objects = t}");
  EXPECT_THAT(job_complaints("include: s.lua\nframes: 1-5000\n", files),
              HasSubstr("its frames differ in more than 1048576 values"));
  EXPECT_THAT(job_complaints("include: s.lua\nframes: 1-10001\n", files),
              HasSubstr("the job has 10001 frames, expected at most 10000"));
  EXPECT_THAT(said("if frame() == 3 then error('no') end return {}"),
              HasSubstr("include: frame 3: in/s.lua:1: no"));
}

TEST(LuaPlaces, CopiesAreAFile) {
  MemoryAssets files;
  files.add(
      "s.lua",
      "return {groups = {g = {objects = {b = {shape = 'box'}}}}, objects = {all = {instance = "
      "'g', places = places{{at = {1, 2, 3}}, {scale = 2, rotate_y = 90}, {scale = {1, 2, 3}, "
      "rotate_x = 90, at = {0, 1, 0}}}}}}");
  ImportingResolver importing(files);
  const auto source = read_scene(importing.sources(), "s.lua");
  SceneRequest request;
  request.made = "s.lua.files/";
  const auto told = (*source)->sections(request);
  ASSERT_TRUE(told) << told.error().message;
  importing.adopt("s.lua", *source);
  const std::string name =
      told->sections->find("objects")->value->map[0].value->find("places")->value->scalar;
  const auto places = read_places(importing, name, 0);
  ASSERT_TRUE(places) << places.error().message;
  ASSERT_EQ((*places)->size(), 3U);
  const auto moved = [&](size_t i, const Vec4& p) {
    const Vec4 q = place_matrix((**places)[i]) * p;
    return fmt::format("{:.3f} {:.3f} {:.3f}", q.x + 0.0F, q.y + 0.0F, q.z + 0.0F);
  };
  EXPECT_EQ(moved(0, {1, 1, 1, 1}), "2.000 3.000 4.000");
  EXPECT_EQ(moved(1, {1, 0, 0, 1}), "-0.000 0.000 -2.000") << "as rotate_y turns";
  EXPECT_EQ(moved(2, {0, 1, 1, 1}), "0.000 -2.000 2.000");
  EXPECT_EQ(job_complaints("include: s.lua\n", files), "");
}

TEST(LuaStrands, AreAFile) {
  MemoryAssets files;
  files.add("s.lua",
            "return {objects = {fur = {curves = strands{{points = {{0, 0, 0}, {0, 1, 0}, {0, 2, "
            "0}}, width = {0.2, 0.1}, color = {1, 0.5, 0}}, {points = {{1, 0, 0}, {1, 1, 0}}, "
            "width = 0.5, color = {0, 0, 1}}}}}}");
  ImportingResolver importing(files);
  const auto source = read_scene(importing.sources(), "s.lua");
  SceneRequest request;
  request.made = "s.lua.files/";
  const auto told = (*source)->sections(request);
  ASSERT_TRUE(told) << told.error().message;
  importing.adopt("s.lua", *source);
  const std::string name =
      told->sections->find("objects")->value->map[0].value->find("curves")->value->scalar;
  const auto strands = read_hair(importing, name, CurveBasis::catmull_rom, 0);
  ASSERT_TRUE(strands) << strands.error().message;
  ASSERT_EQ((*strands)->strand_count(), 2U);
  EXPECT_NEAR((*strands)->piece(0).radius_at(1.0), 0.075, 1e-6);
  EXPECT_NEAR((*strands)->piece(2).radius_at(0.5), 0.25, 1e-6);
  EXPECT_EQ((*strands)->color_at(2, 0.5F), Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(job_complaints("include: s.lua\n", files), "");
}

TEST(LuaStrands, WrongOnesAreToldByNumber) {
  const auto error = [](const std::string& list) {
    return run_lua("return {v = strands{" + list + "}}").error;
  };
  const std::string good = "{points = {{0, 0, 0}, {0, 1, 0}}, width = 1}";
  EXPECT_EQ(error(good), "");
  EXPECT_THAT(error(good + ", {points = {{0, 0, 0}}, width = 1}"),
              HasSubstr("strand 2 has 1 points, expected 2 to 65536"));
  EXPECT_THAT(error("{points = {{0, 0, 0}, {0, 1}}, width = 1}"),
              HasSubstr("points of strand 1 has a table of others, expected 3 numbers"));
  EXPECT_THAT(error("{points = {{0, 0, 0}, {0, 1, 0}}}"),
              HasSubstr("width of strand 1 is a nil, expected a number or {root, tip}"));
  EXPECT_THAT(error("{points = {{0, 0, 0}, {0, 1, 0}}, width = -1}"), HasSubstr("is below 0"));
  EXPECT_THAT(error("{point = {}}"), HasSubstr("strand 1 has the key 'point', expected points,"));
  EXPECT_THAT(error(good + ", {points = {{0, 0, 0}, {0, 1, 0}}, width = 1, color = {1, 1, 1}}"),
              HasSubstr("strand 2 has a color, but those before have none"));
  EXPECT_THAT(error("{points = {{0, 0, 0}, {0, 1, 0}}, width = 1, color = {255, 0, 0}}"),
              HasSubstr("color of strand 1 has 255.0, expected 0 to 1; if they go from 0 to 255"));
  EXPECT_THAT(error(""), HasSubstr("a list without strands"));
}

TEST(LuaPlaces, TheTownTakesAHundredthOfTheSteps) {
  const auto folder = make_file_resolver("jobs/town");
  const ScriptSettings set;
  lua::ScriptRequest request{*folder, "town.lua", set, "made/"};
  request.limits.steps /= 100;
  const auto town = lua::run_script(request);
  ASSERT_TRUE(town) << town.error().message;
  size_t copies = 0;
  for (const auto& [name, file] : town->made) copies += file.size() / (12 * sizeof(float));
  EXPECT_GE(copies, 100'000U);
  const auto again = lua::run_script(request);
  ASSERT_TRUE(again);
  EXPECT_EQ(write_yaml(*again->tree), write_yaml(*town->tree)) << "names of files are hashes";
}

TEST(LuaPlaces, WrongCopiesAreToldByNumber) {
  const auto error = [](const std::string& list) {
    return run_lua("return {v = places{" + list + "}}").error;
  };
  EXPECT_THAT(
      error("{}, {at = {1, 2}}"),
      StartsWith("a/scene.lua:1: at of copy 2 is a table without three numbers, expected {x, "
                 "y, z}"));
  EXPECT_THAT(error("{at = {1, 2, 'x'}}"), HasSubstr("at of copy 1 is a string"));
  EXPECT_THAT(error("{rotate_y = 0/0}"), HasSubstr("expected a finite number"));
  EXPECT_THAT(error("{turn = 3}"), HasSubstr("copy 1 has the key 'turn', expected at, scale,"));
  EXPECT_THAT(error("{}, 3"), HasSubstr("copy 2 is a number, expected a table"));
  EXPECT_THAT(error("{scale = {1, 0, 1}}"), HasSubstr("copy 1 is flat or too small"));
  EXPECT_THAT(error(""), HasSubstr("a list without copies"));
}

}  // namespace
}  // namespace hyades::core
