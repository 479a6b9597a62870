// A scene in Lua, with little to spend.

#include "import/lua/script_run.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_files.h"

namespace hyades::fuzz {

std::vector<std::string> seeds() {
  return {
      R"(local n = param("n", 3, "how many")
local rnd = random(7)
local t = {}
for i = 1, n do t["b" .. i] = {shape = "sphere", at = {rnd(), rnd(5), rnd(-2, 2)}} end
for k, v in pairs(t) do v.radius = #k + 0.5 end
return {objects = t, camera = {fov = {keys = {[1] = 20, [4] = 30}}}})",
      R"(local p = include("p.lua", param("n", 1))
local ok, e = pcall(error, {1})
local s = string.format("%5.2f %s", math.sin(time()), tostring(ok)):gsub("%d+", "x")
local list = {{at = {1, 2, 3}, scale = 2, rotate_x = 4}, {rotate_z = frame()}}
table.sort(list, function(a, b) return (a.scale or 0) < (b.scale or 0) end)
return {name = s, objects = {a = {instance = p.name, places = places(list)}}, x = {next({1, a = 2})}})",
      R"(local n, m = param("n", 0.5), setmetatable({}, {__index = function(t, k) return k * 2 end, __close = print})
goto done
do local x <close> = m end
::done::
return {v = {m[1], utf8.len("äö"), ("a,b"):find(",", 1, true), table.concat({1, 2}, "-"),
  table.unpack({1, 2, 3}), 7 // 2, 1 << 3, #"abc", math.pow(2, 0.5), string.rep("ab", 3, "c")}})"};
}

bool try_input(std::string_view input) {
  Files files("s.lua", input);
  files.add("p.lua", "return {name = 'g'}");
  const core::ScriptSettings set = {{"n", "2"}};
  core::lua::ScriptRequest request{files, "s.lua", set, "s.lua.files/"};
  request.limits.steps = 200'000;
  request.limits.memory = size_t{8} << 20;
  request.limits.text = size_t{1} << 20;
  return core::lua::run_script(request).ok();
}

}  // namespace hyades::fuzz
