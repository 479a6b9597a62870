-- A creature that is all fur: tufts of strands on a ball, longer on top, each tuft drawn together at its tip.
local tufts = param("tufts", 5200, "tufts of its fur")
local each = param("each", 16, "strands of a tuft")
local rnd = random(param("seed", 5, "another seed, another hairdo"))
local function spread(width) return width * (rnd() + rnd() - 1) end

local function add(a, b, f) return {a[1] + f * b[1], a[2] + f * b[2], a[3] + f * b[3]} end
local function unit(a)
  local length = math.sqrt(a[1] * a[1] + a[2] * a[2] + a[3] * a[3])
  return {a[1] / length, a[2] / length, a[3] / length}
end

local back, front = {0.5, 0.16, 0.04}, {0.85, 0.6, 0.36}  -- its colours

-- Where the face is, fur is short and combed away from it.
local face = unit{0, 0.12, 1}
local list = {}

-- A strand from a root on the body, along the normal, bent by what combs it and by its weight.
local function strand(root, normal, comb, length, tip, color)
  local points = {}
  for i = 0, 6 do
    local t = i / 6
    local p = add(add(root, normal, length * t * (1 - 0.35 * t)), comb, length * t * t)
    local pull = 0.65 * t * t
    points[#points + 1] = {p[1] + pull * (tip[1] - p[1]), p[2] + pull * (tip[2] - p[2]), p[3] + pull * (tip[3] - p[3])}
  end
  list[#list + 1] = {points = points, width = {0.011, 0.002}, color = color}
end

for k = 1, tufts do
  -- Even over the ball: Fibonacci's spiral.
  local y = 1 - 2 * (k - 0.5) / tufts
  local around = math.sqrt(1 - y * y)
  local n = {around * math.cos(2.39996 * k), y, around * math.sin(2.39996 * k)}
  local toward = n[1] * face[1] + n[2] * face[2] + n[3] * face[3]
  local near = math.exp(-((1 - toward) / 0.16) ^ 2)
  local crown = math.exp(-((1 - n[2]) / 0.07) ^ 2)
  local away = unit(add(n, face, -toward))
  local comb = add(add({spread(0.25), -0.55 + 0.9 * crown, spread(0.25)}, away, 0.9 * near), {0.25 * crown, 0, -0.3 * crown}, 1)
  local length = (0.36 + 0.34 * crown + spread(0.05)) * (1 - 0.62 * near)
  local middle = {0.92 * n[1], 0.9 * n[2], 0.92 * n[3]}
  local tip = add(add(middle, n, 0.65 * length), comb, length)
  local shade = 0.85 + 0.3 * rnd()
  local belly = math.max(0, math.min(1, -0.15 - 1.6 * n[2] + 0.6 * near))
  for _ = 1, each do
    local m = unit{n[1] + spread(0.035), n[2] + spread(0.035), n[3] + spread(0.035)}
    local root = {0.92 * m[1], 0.9 * m[2], 0.92 * m[3]}
    local own = shade * (0.9 + 0.2 * rnd())
    local color = {}
    for c = 1, 3 do color[c] = math.min(0.95, own * (back[c] + belly * (front[c] - back[c]))) end
    strand(root, m, add(comb, {spread(0.3), spread(0.3), spread(0.3)}, 1), length * (0.8 + 0.4 * rnd()), tip, color)
  end
end

return {objects = {fur = {curves = strands(list), material = "fur", at = {0, 1.12, 0}}}}
