// What kustomize makes of a folder of deploy/kubernetes, for machines without a kubectl that can: only what these folders
// ask of it; anything else is an error. Generated config maps keep their plain names. With a file of what kustomize
// made, says instead whether that is the same. usage: build_overlay.js FOLDER [FILE.yaml]
const fs = require('fs');
const path = require('path');
const {isDeepStrictEqual} = require('util');
const yaml = require('js-yaml');

// Kustomize reads YAML 1.1, where 0555 is octal.
const parse = (text) => yaml.loadAll(text.replace(/: 0([0-7]+)\b/g, ': 0o$1')).filter(Boolean);
const read = (file) => parse(fs.readFileSync(file, 'utf8'));
const is_map = (value) => value instanceof Object && !Array.isArray(value);

function demand(right, what) {
  if (right) return;
  console.error(what);
  process.exit(1);
}

// A strategic merge: maps key by key, lists of things with names by name, new ones first, other lists as a whole.
function merge(into, patch) {
  for (const [key, value] of Object.entries(patch)) {
    if (is_map(value) && is_map(into[key])) merge(into[key], value);
    else if (Array.isArray(value) && Array.isArray(into[key]) && value.every((one) => one.name)) {
      const fresh = value.filter((one) => !into[key].some((other) => other.name === one.name));
      for (const one of value) {
        const same = into[key].find((other) => other.name === one.name);
        if (same) merge(same, one);
      }
      into[key].unshift(...fresh);
    } else into[key] = value;
  }
}

function apply(patch, objects, folder) {
  const chosen = objects.filter((o) => o.kind === patch.target.kind && o.metadata.name === patch.target.name);
  demand(chosen.length === 1, `${folder}: a patch of ${chosen.length} objects`);
  if (patch.path) {
    const [changes] = read(path.join(folder, patch.path));
    demand(changes.metadata.name === patch.target.name, `${folder}: ${patch.path} is of another object`);
    return merge(chosen[0], changes);
  }
  for (const step of parse(patch.patch)[0]) {
    const keys = step.path.split('/').slice(1);
    const holder = keys.slice(0, -1).reduce((o, key) => o[key], chosen[0]);
    demand(step.op === 'remove' && keys.at(-1) in holder, `${folder}: ${step.op} ${step.path}`);
    delete holder[keys.at(-1)];
  }
}

function build(folder) {
  const [{apiVersion, kind, namespace, resources, configMapGenerator = [], patches = [], images = [], ...rest}] =
    read(path.join(folder, 'kustomization.yaml'));
  demand(kind === 'Kustomization' && Object.keys(rest).length === 0, `${folder}: ${Object.keys(rest)} of a ${kind}`);
  const objects = resources.flatMap((name) => {
    const file = path.join(folder, name);
    return fs.statSync(file).isDirectory() ? build(file) : read(file);
  });
  for (const {name, files} of configMapGenerator) {
    const data = Object.fromEntries(files.map((file) => [file, fs.readFileSync(path.join(folder, file), 'utf8')]));
    objects.push({apiVersion: 'v1', kind: 'ConfigMap', metadata: {name}, data});
  }
  for (const patch of patches) apply(patch, objects, folder);
  for (const o of objects) {
    if (namespace && !['Namespace', 'PriorityClass'].includes(o.kind)) {
      o.metadata.namespace = namespace;
      for (const subject of o.subjects || []) subject.namespace = namespace;
    }
    for (const container of ((o.spec || {}).template || {spec: {containers: []}}).spec.containers) {
      const image = images.find((one) => one.name === container.image);
      if (image) container.image = `${image.newName}:${image.newTag}`;
    }
  }
  return objects;
}

const built = build(process.argv[2]);
if (!process.argv[3]) {
  console.log(built.map((o) => yaml.dump(o, {sortKeys: true, noArrayIndent: true, lineWidth: -1})).join('---\n'));
} else {
  const plain = fs.readFileSync(process.argv[3], 'utf8').replace(/(name: scale-workers)-[0-9a-z]{10}$/gm, '$1');
  const by_name = (objects) => new Map(objects.map((o) => [`${o.kind} ${o.metadata.name}`, o]));
  const [ours, theirs] = [by_name(built), by_name(parse(plain))];
  const others = [...new Set([...ours.keys(), ...theirs.keys()])].filter((one) => !isDeepStrictEqual(ours.get(one), theirs.get(one)));
  demand(others.length === 0, `${process.argv[2]}: kustomize makes something else of ${others}`);
}
