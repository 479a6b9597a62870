// A job without files of its own, for a first picture.

export const EXAMPLE = `# A first picture: four balls at dusk
hyades: 1
name: first-light
film: {size: [640, 360]}
sampling: {samples: 256}
camera: {look_from: [0, 1.7, 6.5], look_at: [0, 0.75, 0], fov: 34}
textures:
  tiles: {type: checker, scale: 60, a: [0.42, 0.4, 0.38], b: [0.12, 0.13, 0.16]}
materials:
  floor: {type: glossy, color: tiles, reflectiveness: 0.3, glossiness: 0.9}
  gold: {type: conductor, metal: gold, roughness: 0.15}
  glass: {type: dielectric, ior: 1.5}
  clay: {type: lambert, color: [0.7, 0.22, 0.12]}
  sea: {type: glossy, color: [0.05, 0.25, 0.35], reflectiveness: 0.1, glossiness: 0.95}
objects:
  ground: {shape: rectangle, size: [60, 60], material: floor}
  sun: {shape: sphere, radius: 0.85, at: [0.1, 0.85, 0], material: gold}
  lens: {shape: sphere, radius: 0.6, at: [-1.5, 0.6, 1.1], material: glass}
  pot: {shape: sphere, radius: 0.7, at: [-1.9, 0.7, -1.2], material: clay}
  wave: {shape: sphere, radius: 0.55, at: [1.6, 0.55, 0.5], material: sea}
  lamp: {shape: sphere, radius: 0.4, at: [-3, 4.5, 3], emit: {color: 3600K, power: 700}}
environment: {color: [0.16, 0.2, 0.32]}
outputs:
  - {file: first-light.png, tone_map: agx, exposure: 0.5}
  - {file: first-light.exr}
`;
