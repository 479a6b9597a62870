import assert from 'node:assert/strict';
import test from 'node:test';
import { joining } from '../../../../coordinator/web/dashboard/joining.js';

const page = { hostname: 'farm.example', secure: false };
const command = (...of) => joining(...of).command;

test('a farm that listens to its own machine only says so', () => {
  assert.deepEqual(joining('127.0.0.1:7700', { hostname: 'localhost', secure: false }, false), {
    command: 'hyades worker',
    where: 'On the coordinator’s machine, the only one that this farm listens to:',
  });
  assert.equal(command('127.0.0.1:7800', page, false), 'hyades worker --coordinator 127.0.0.1:7800');
});

test('one that listens everywhere is called as the page is', () => {
  assert.equal(command('0.0.0.0:7700', page, false), 'hyades worker --coordinator farm.example:7700');
  assert.equal(command('[::]:7800', page, false), 'hyades worker --coordinator farm.example:7800');
  assert.equal(command('0.0.0.0:7700', { hostname: 'localhost' }, false), 'hyades worker --coordinator HOST:7700');
  assert.equal(command('', page, false), 'hyades worker --coordinator farm.example:7700');
});

test('one with TLS and tokens wants both', () => {
  assert.equal(
    command('farm.example:7700', { hostname: 'farm.example', secure: true }, true),
    'hyades worker --coordinator farm.example:7700 --tls-ca ca.pem --token-file worker.token',
  );
});
