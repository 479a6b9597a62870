import assert from 'node:assert/strict';
import test from 'node:test';
import {
  clearlyFirst,
  folderOf,
  framesOf,
  fromFolder,
  includesOf,
  isHidden,
  isNamed,
  isYaml,
  likelyJobs,
} from '../../../../coordinator/web/dashboard/gather.js';
import { complaints, pieces } from '../../../../coordinator/web/dashboard/yaml_text.js';

test('files are called as the folder of the job sees them', () => {
  assert.equal(folderOf('shots/a/job.yaml'), 'shots/a/');
  assert.equal(folderOf('job.yaml'), '');
  assert.equal(fromFolder('', 'tex/wood.png'), 'tex/wood.png');
  assert.equal(fromFolder('shots/a/', 'shots/a/job.yaml'), 'job.yaml');
  assert.equal(fromFolder('shots/a/', 'shots/a/tex/wood.png'), 'tex/wood.png');
  assert.equal(fromFolder('shots/a/', 'shots/lib/sky.exr'), '../lib/sky.exr');
  assert.equal(fromFolder('shots/a/', 'other/x.ply'), '../../other/x.ply');
  assert.equal(fromFolder('a/', 'a'), '../a');
});

test('what tools leave behind is hidden', () => {
  for (const path of ['.git/config', 'a/.DS_Store', 'Thumbs.db', '__MACOSX/a', 'out/.hyades/log'])
    assert.ok(isHidden(path), path);
  for (const path of ['a.b/c', 'job.yaml', 'tex/a..png']) assert.ok(!isHidden(path), path);
  assert.ok(isYaml('a/Job.YML') && !isYaml('yaml') && !isYaml('a.yaml.bak'));
});

test('includes are found in both ways to write them', () => {
  assert.deepEqual(includesOf('include: sky.yaml # the sky\nname: a'), ['sky.yaml']);
  assert.deepEqual(includesOf('include: [base.yaml, "two words.yaml"]'), ['base.yaml', 'two words.yaml']);
  assert.deepEqual(includesOf('hyades: 1\ninclude:\n  - a.yaml\n  - lib/b.yaml\nfilm: {}'), ['a.yaml', 'lib/b.yaml']);
  assert.deepEqual(includesOf('objects:\n  a: {include: x}'), []);
});

test('the job is what includes others, not what is included', () => {
  const shot = { path: 'shot/job.yaml', text: 'hyades: 1\ninclude: lib/scene.yaml\n' };
  const scene = { path: 'shot/lib/scene.yaml', text: 'hyades: 1\nfilm: {size: [1, 1]}\n' };
  assert.deepEqual(likelyJobs([scene, shot]), ['shot/job.yaml', 'shot/lib/scene.yaml']);
  assert.ok(clearlyFirst([scene, shot]));
});

test('of two jobs the person is asked', () => {
  const a = { path: 'a.yaml', text: 'hyades: 1\n' };
  const b = { path: 'b.yaml', text: 'hyades: 1\n' };
  assert.ok(!clearlyFirst([a, b]));
  assert.ok(clearlyFirst([a]));
  assert.ok(clearlyFirst([a, { path: 'notes.yaml', text: 'x: 1\n' }]));
  assert.deepEqual(likelyJobs([b, a]), ['a.yaml', 'b.yaml']);
});

test('files that no text names are told apart', () => {
  const texts = ['mesh: tex/wood.ply\nimage: "tile.<UDIM>.exr"\nsequence: body.####.ply'];
  for (const path of ['tex/wood.ply', 'body.0012.ply', 'tile.1001.exr']) assert.ok(isNamed(path, texts), path);
  for (const path of ['tex/stone.ply', 'body.12.ply', 'other.1001.exr']) assert.ok(!isNamed(path, texts), path);
});

test('frames are read as the command line reads them', () => {
  assert.deepEqual(framesOf(''), []);
  assert.deepEqual(framesOf('7'), [{ first: 7, last: 7, step: 1 }]);
  assert.deepEqual(framesOf('1-24x2, 30'), [
    { first: 1, last: 24, step: 2 },
    { first: 30, last: 30, step: 1 },
  ]);
  for (const bad of ['a', '1-', '5-1', '1-9x0', '1..9', '1-2-3'])
    assert.throws(() => framesOf(bad), /^Error: Frames/, bad);
});

test('complaints are read with file and line', () => {
  assert.deepEqual(complaints("scene.yaml:3:17: shape is 'spher'\nC:/a b/job.yaml:12:1: unknown key: 'x'\n"), [
    { file: 'scene.yaml', line: 3, column: 17, text: "shape is 'spher'" },
    { file: 'C:/a b/job.yaml', line: 12, column: 1, text: "unknown key: 'x'" },
  ]);
  assert.deepEqual(complaints('there is no file a.ply'), [
    { file: '', line: 0, column: 0, text: 'there is no file a.ply' },
  ]);
  assert.equal(complaints('a.yaml:1:2: first\n  and more')[0].text, 'first\nand more');
});

test('coloured lines are still the lines', () => {
  const lines = [
    'a: {b: "x # y", c: [1, 2]}  # remark',
    "- {file: 'it''s.png'}",
    '   ',
    '',
    'url: http://x/#frag',
    'broken: "no end',
    '  - - deep: 1',
  ];
  for (const line of lines)
    assert.equal(
      pieces(line)
        .map(([, text]) => text)
        .join(''),
      line,
    );
  assert.deepEqual(
    pieces('a: 1 # b').filter(([kind]) => kind),
    [
      ['key', 'a'],
      ['remark', '# b'],
    ],
  );
  assert.ok(!pieces('"x # y"').some(([kind]) => kind === 'remark'));
});
