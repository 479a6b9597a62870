-- A ball of chrome among coloured planes, which turn around it like the pages of a book: all that moves is computed from time().
local count = param("planes", 24, "how many planes")

-- The colour of a hue from 0 to 1 (HSV with full value).
local function hue(h, saturation)
  local function channel(shift)
    local x = math.abs((h + shift) % 1 * 6 - 3) - 1
    return 1 - saturation * (1 - math.max(0, math.min(1, x)))
  end
  return {0.85 * channel(0), 0.85 * channel(2 / 3), 0.85 * channel(1 / 3)}
end

local materials = {
  chrome = {type = "conductor", metal = "chromium", roughness = 0.02},
  floor = {type = "glossy", color = {0.72, 0.7, 0.68}, reflectiveness = 0.25, glossiness = 0.9},
}
local objects = {
  floor = {shape = "rectangle", size = {400, 400}, material = "floor"},
  ball = {shape = "sphere", radius = 1.15, at = {0, 1.6 + 0.12 * math.sin(math.pi * time()), 0}, material = "chrome"},
}
for i = 1, count do
  local name = string.format("plane_%02d", i)
  local height = 1 + 0.4 * math.sin(4 * math.pi * i / count)
  local turn = 360 * i / count + 15 * time()
  materials[name] = {type = "lambert", color = hue(i / count, 0.85)}
  objects[name] = {
    shape = "box",
    size = {1.3, height, 0.03},
    material = name,
    transform = {{rotate_y = 24}, {translate = {2.5, height / 2, 0}}, {rotate_y = turn}},
  }
end

return {
  name = "sphere-and-planes",
  frames = {range = "1-96", fps = 24, shutter = 0.5},
  film = {size = {720, 400}},
  sampling = {samples = 256, seed = 4},
  integrator = {type = "path", max_depth = 8},
  camera = {look_from = {0, 2.7, 9.4}, look_at = {0, 1.05, 0}, fov = 34},
  materials = materials,
  objects = objects,
  environment = {sky = {elevation = 28, azimuth = 130, turbidity = 2.5, sun_size = 4}, strength = 3.2},
  outputs = {{file = "sphere-and-planes.####.exr"}, {file = "sphere-and-planes.####.png", tone_map = "filmic"}},
}
