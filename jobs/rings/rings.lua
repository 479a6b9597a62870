-- Rings within rings, each turned a little further than the one around it, and a bright ball in their middle; a lamp behind them
-- throws their shadows into the fog.
local count = param("rings", 5, "how many rings")
local twist = param("twist", 20, "degrees that each ring is turned against the one around it")

local center = {0, 2.3, 0}
local objects = {
  ground = {shape = "rectangle", size = {80, 80}, material = "stone"},
  core = {shape = "sphere", radius = 0.26, at = center, material = "gold"},
}
for i = 1, count do
  -- A ring is a row of short rods around a circle.
  local radius = 0.2 + 0.36 * i
  local rods, parts = 192, {}
  for k = 1, rods do
    local angle = 360 * k / rods
    parts[string.format("rod_%03d", k)] = {
      shape = "box",
      size = {2.02 * (radius + 0.12) * math.tan(math.pi / rods), 0.05, 0.24},
      transform = {{translate = {0, 0, radius}}, {rotate_y = angle}},
    }
  end
  objects[string.format("ring_%d", i)] = {
    group = {objects = parts},
    material = i % 3 == 0 and "gold" or "bronze",
    transform = {{rotate_x = twist * (count - i)}, {rotate_x = 60}, {rotate_y = 40 - 14 * (count - i)}},
    at = center,
  }
end

return {
  name = "rings",
  film = {size = {640, 400}},
  sampling = {samples = 512, seed = 5},
  integrator = {type = "bdpt", max_depth = 3},
  camera = {look_from = {1.1, 1.2, 9.6}, look_at = {0.75, 1.85, 0}, fov = 31},
  media = {fog = {scattering = {0.018, 0.021, 0.026}, absorption = 0.002, g = 0.7}},
  atmosphere = "fog",
  materials = {
    stone = {type = "lambert", color = {0.18, 0.17, 0.16}},
    bronze = {type = "conductor", metal = "brass", roughness = 0.4},
    gold = {type = "conductor", metal = "gold", roughness = 0.2},
  },
  objects = objects,
  lights = {
    beam = {type = "spot", at = {-10.4, 9.55, -12.05}, look_at = center, angle = 7.1, blend = 0.1, power = 46000, color = "3600K"},
    sky = {type = "point", at = {3.5, 5, 6}, power = 60, color = {0.4, 0.6, 1}},
  },
  outputs = {{file = "rings.exr"}, {file = "rings.png", tone_map = "filmic", exposure = 1}},
}
