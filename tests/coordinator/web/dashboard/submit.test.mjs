import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import test from 'node:test';

globalThis.document = { baseURI: 'http://farm:8080/' };
const { Bundle } = await import('../../../../coordinator/web/dashboard/bundle.js');
const { ofDrop } = await import('../../../../coordinator/web/dashboard/gather.js');
const { hashAll, uploadAll } = await import('../../../../coordinator/web/dashboard/upload.js');

const given = (files) =>
  Object.entries(files).map(([path, text]) => ({ path, file: new File([text], path.split('/').pop()) }));
const hex = (bytes) => createHash('sha256').update(bytes).digest('hex');

test('a folder is taken as its job sees it, without what tools leave in it', async () => {
  const bundle = new Bundle();
  await bundle.add(
    given({
      'shot/job.yaml': 'hyades: 1\ninclude: ../lib/sky.yaml\nobjects: {a: {mesh: a.ply}}\n',
      'lib/sky.yaml': 'hyades: 1\n',
      'shot/a.ply': 'ply',
      'shot/.git/config': 'x',
      'shot/notes.txt': 'x',
    }),
  );
  assert.equal(bundle.job, 'shot/job.yaml');
  assert.equal(bundle.title(), 'shot');
  const names = bundle.chosen().map(({ path }) => bundle.nameOf(path));
  assert.deepEqual(names.sort(), ['../lib/sky.yaml', 'a.ply', 'job.yaml', 'notes.txt']);
  assert.deepEqual(
    bundle.files.filter((entry) => !bundle.isNamed(entry)).map(({ path }) => path),
    ['shot/notes.txt'],
  );
  assert.equal(bundle.documentOf({ file: '../lib/sky.yaml' }), 'lib/sky.yaml');
  assert.equal(bundle.documentOf({ file: 'other.yaml' }), null);
});

test('nobody guesses between two jobs, and meshes can come later', async () => {
  const bundle = new Bundle();
  await bundle.add(given({ 'a.yaml': 'hyades: 1\nname: first\n', 'b.yaml': 'hyades: 1\n' }));
  assert.equal(bundle.job, null);
  bundle.job = 'a.yaml';
  assert.equal(bundle.title(), 'first');
  await bundle.add(given({ 'a.ply': 'ply' }));
  assert.equal(bundle.job, 'a.yaml');
  assert.equal(bundle.files.length, 3);
  await bundle.add(given({ 'c/job.yaml': 'hyades: 1\n' }));
  assert.deepEqual(
    bundle.files.map(({ path }) => path),
    ['c/job.yaml'],
  );
});

test('without a job nothing changes, and the reason is said', async () => {
  const bundle = new Bundle();
  await assert.rejects(bundle.add(given({ 'a.png': 'x' })), /no YAML/);
  await assert.rejects(bundle.add(given({ 'robot.glb': 'x' })), /include: SCENE/);
  await assert.rejects(bundle.add(given({ '.hidden': 'x' })), /no file/);
  assert.equal(bundle.files.length, 0);
});

test('a mended text is what is sent', async () => {
  const bundle = new Bundle();
  await bundle.add(given({ 'job.yaml': 'hyades: 1\nbad\n' }));
  bundle.replace('job.yaml', 'hyades: 1\n');
  assert.equal(bundle.textOf('job.yaml'), 'hyades: 1\n');
  assert.equal(await bundle.chosen()[0].file.text(), 'hyades: 1\n');
});

test('dropped folders are walked through, in as many pieces as the browser gives', async () => {
  const file = (name) => ({ name, isFile: true, file: (done) => done(new File(['x'], name)) });
  const folder = (name, pieces) => ({
    name,
    isFile: false,
    createReader: () => {
      const left = [...pieces, []];
      return { readEntries: (done) => done(left.shift()) };
    },
  });
  const tree = folder('shot', [
    [file('job.yaml'), folder('tex', [[file('a.png')], [file('b.png')]])],
    [file('c.ply'), folder('.git', [[file('config')]])],
  ]);
  const files = await ofDrop({ items: [{ webkitGetAsEntry: () => tree }], files: [] });
  assert.deepEqual(
    files.map(({ path }) => path),
    ['shot/job.yaml', 'shot/tex/a.png', 'shot/tex/b.png', 'shot/c.ply'],
  );
});

/** A coordinator that takes pieces; `breaks(n)`: whether its n-th piece is lost on the way, after it came or before. */
function coordinator(breaks = () => null) {
  const store = new Map();
  const sizes = new Map();
  const log = [];
  let pieces = 0;
  globalThis.fetch = async (address, { method, body }) => {
    const url = new URL(address);
    const answer = (value, status = 200) => new Response(JSON.stringify(value), { status });
    if (url.pathname.endsWith('/missing')) {
      log.push('missing');
      const { files } = JSON.parse(body);
      for (const { sha256, size } of files) sizes.set(sha256, size);
      const missing = files.filter(({ sha256, size }) => (store.get(sha256)?.length ?? -1) < size);
      return answer({ missing: missing.map(({ sha256 }) => ({ sha256, offset: store.get(sha256)?.length ?? 0 })) });
    }
    assert.equal(method, 'PUT');
    const sum = url.pathname.split('/').pop();
    const offset = Number(url.searchParams.get('offset'));
    const lost = breaks(++pieces);
    if (lost === 'before') throw new TypeError('network');
    const have = store.get(sum) ?? Buffer.alloc(0);
    if (offset !== have.length) return answer({ error: { code: 'out_of_range', message: 'another offset' } }, 400);
    store.set(sum, Buffer.concat([have, Buffer.from(await new Response(body).arrayBuffer())]));
    if (lost === 'after') throw new TypeError('network');
    return answer({ offset: store.get(sum).length, complete: store.get(sum).length === sizes.get(sum) });
  };
  return { store, log };
}

const quick = { aborted: false, addEventListener: () => {} };

test('files arrive whole, each content once, though the line breaks', async () => {
  const large = Buffer.alloc(3_500_000, 'abc');
  const files = [
    { path: 'a', file: new File([large], 'a') },
    { path: 'b', file: new File(['small'], 'b') },
    { path: 'copy of a', file: new File([large], 'a') },
    { path: 'empty', file: new File([], 'empty') },
  ];
  await hashAll(files, () => {}, quick);
  assert.equal(files[0].sha256, hex(large));
  const { store, log } = coordinator((n) => ({ 2: 'before', 4: 'after' })[n]);
  const told = [];
  await uploadAll(files, (now) => told.push(now), quick);
  assert.equal(store.size, 3);
  for (const [sum, bytes] of store) assert.equal(hex(bytes), sum);
  assert.ok(log.length >= 2, 'it asks again where to go on');
  assert.ok(told.some(({ waiting }) => waiting !== ''));
  assert.equal(told.at(-1).total, large.length + 5);
  assert.equal(told.at(-1).sent, told.at(-1).total);
});

test('what is there is not sent again', async () => {
  const files = [{ path: 'a', file: new File(['abc'], 'a') }];
  await hashAll(files, () => {}, quick);
  const { store } = coordinator(() => assert.fail('nothing is to be sent'));
  store.set(files[0].sha256, Buffer.from('abc'));
  await uploadAll(files, () => {}, quick);
});

test('a refusal that will stay ends it', async () => {
  const files = [{ path: 'a', file: new File(['abc'], 'a') }];
  await hashAll(files, () => {}, quick);
  coordinator();
  const { fetch } = globalThis;
  globalThis.fetch = (address, options) =>
    options.method === 'PUT'
      ? Promise.resolve(
          new Response(JSON.stringify({ error: { code: 'permission_denied', message: 'no' } }), { status: 403 }),
        )
      : fetch(address, options);
  await assert.rejects(
    uploadAll(files, () => {}, quick),
    (error) => error.code === 'permission_denied',
  );
});
