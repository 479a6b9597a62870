// The modules as one file (bundle_modules.cmake), as the coordinator's program carries them.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import test from 'node:test';
import { fileURLToPath } from 'node:url';

const web = fileURLToPath(new URL('../../../../coordinator/web', import.meta.url));
const skip = spawnSync('cmake', ['--version']).error ? 'cmake is not here' : false;

/** Bundles modules, {name: text}; gives {text, result} or what was complained of. */
function bundle(t, modules) {
  const folder = mkdtempSync(`${tmpdir()}/bundle-`);
  t.after(() => rmSync(folder, { recursive: true }));
  for (const [name, text] of Object.entries(modules)) writeFileSync(`${folder}/${name}.js`, text);
  const script = [`-DENTRY=${folder}/main.js`, `-DOUTPUT=${folder}/out.mjs`, '-P', `${web}/bundle_modules.cmake`];
  const run = spawnSync('cmake', script, { encoding: 'utf8' });
  if (run.status !== 0) return { problem: run.stderr };
  const result = execFileSync('node', [`${folder}/out.mjs`], { encoding: 'utf8' });
  return { result, text: readFileSync(`${folder}/out.mjs`, 'utf8') };
}

test('one file does what its modules do, each of them once', { skip }, (t) => {
  const { result } = bundle(t, {
    main: "import { add as sum,\n  two } from './sum.js';\nimport * as other from './other.js';\nconsole.log(sum(two, 3), other.Thing.name, other.list);\n",
    other:
      "// A comment; with a semicolon\nimport { two } from './sum.js';\nexport class Thing {}\nexport const list = [`${two}]`, 'a;b', '\\\\n'];\n",
    sum: "console.log('begun');\nexport function add(a, b) {\n  return a + b;\n}\nexport const two = 2;\n",
  });
  assert.equal(result, "begun\n5 Thing [ '2]', 'a;b', '\\\\n' ]\n");
});

test('what is not understood ends it, with the name of the file', { skip }, (t) => {
  const problem = (modules) => bundle(t, modules).problem?.replace(/\s+/g, ' ') ?? 'none';
  const a = 'export const a = 1;\n';
  assert.match(problem({ main: "import b from './a.js';\n", a }), /main\.js: this import is not understood/);
  assert.match(problem({ main: "import './a.js';\n", a }), /main\.js: this import is not understood/);
  assert.match(
    problem({ main: "import { a } from './a.js';\n", a: 'export default 3;\n' }),
    /a\.js: this is not understood/,
  );
  assert.match(
    problem({
      main: "import { a } from './a.js';\n",
      a: `import { b } from './b.js';\n${a}`,
      b: `import { a } from './a.js';\nexport const b = 1;\n`,
    }),
    /in a circle: .*main > a > b > a/,
  );
});

test('the dashboard is one file', { skip }, (t) => {
  const folder = mkdtempSync(`${tmpdir()}/bundle-`);
  t.after(() => rmSync(folder, { recursive: true }));
  execFileSync('cmake', [
    `-DENTRY=${web}/dashboard/main.js`,
    `-DOUTPUT=${folder}/app.mjs`,
    '-P',
    `${web}/bundle_modules.cmake`,
  ]);
  execFileSync('node', ['--check', `${folder}/app.mjs`]);
  assert.match(readFileSync(`${web}/dashboard/index.html`, 'utf8'), /src="dashboard\/app\.js"/);
});
