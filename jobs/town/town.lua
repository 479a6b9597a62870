-- A town on both sides of a river: towers in the middle, gables around them, gardens everywhere.
local count = param("count", 100000, "houses and trees together")
local rnd = random(param("seed", 7, "another seed, another town"))
local function between(low, high) return low + (high - low) * rnd() end
local function river(z) return 150 * math.sin(z / 420) + 60 * math.sin(z / 170) end

-- A list of copies for each kind of house and tree; the river is a row of round pieces.
local kinds = {"glass", "stone", "brick", "plaster", "ochre", "pine", "beech"}
local copies, placed = {pond = {}}, 0
for _, kind in ipairs(kinds) do copies[kind] = {} end
for z = -6000, 6000, 20 do table.insert(copies.pond, {at = {river(z), 0.1, z}, scale = {44, 1, 44}}) end
local function put(kind, x, z, width, height, depth, turn)
  table.insert(copies[kind], {at = {x, 0, z}, scale = {width, height, depth}, rotate_y = turn})
  placed = placed + 1
end

-- One lot: a tower near the middle, else a house with up to two trees behind it.
local function build(x, z)
  local far = math.sqrt(x * x + z * z)
  if placed >= count or math.abs(x - river(z)) < 46 or rnd() < 0.04 then return end
  if rnd() < 0.8 * math.exp(-far / 170) then
    put(kinds[rnd(2)], x, z, between(9, 12), between(12, 20) + 110 * rnd() * math.exp(-far / 130), between(9, 12), 0)
    return
  end
  put(kinds[rnd(3, 5)], x, z, between(7, 10), between(5, 9), between(8, 11), 90 * rnd(0, 3) + between(-4, 4))
  for _ = 1, rnd(0, 2) do
    local size = between(3, 6)
    put(kinds[rnd(6, 7)], x + between(-7, 7), z + between(5, 9), size, between(5, 11), size, between(0, 360))
  end
end

-- Blocks of four lots by three with streets between them, ring after ring around the middle.
local function block(column, row)
  for i = 0, 11 do build(62 * column + 13 * (i % 4), 68 * row + 18 * (i // 4)) end
end
local ring = 0
while placed < count do
  for i = -ring, ring do
    block(i, -ring)
    if ring > 0 then block(i, ring) end
    if math.abs(i) < ring then block(-ring, i) block(ring, i) end
  end
  ring = ring + 1
end

local objects = {}
for kind, list in pairs(copies) do
  if #list > 0 then objects[kind] = {instance = kind, places = places(list)} end
end
return {objects = objects}
