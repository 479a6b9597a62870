// Signing in and out, and a coordinator that starts again under a page (run starts this; it has a coordinator of its own, with a token).
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { setTimeout as sleep } from 'node:timers/promises';

const { HYADES_BIN: bin, HYADES_SCRATCH: scratch } = process.env;
const token = 'a-token-of-enough-letters';
const data = `${scratch}/guarded`;
writeFileSync(`${scratch}/token`, `${token}\n`);

let coordinator;
/** Gives the dashboard's address. */
async function start(http) {
  rmSync(`${data}/http-address`, { force: true });
  const options = ['--data', data, '--listen', '127.0.0.1:0', '--http', http, '--token-file', `${scratch}/token`];
  coordinator = spawn(`${bin}/hyades-coordinator`, ['coordinator', ...options], { stdio: 'ignore' });
  for (let i = 0; i < 300; ++i) {
    try {
      const address = readFileSync(`${data}/http-address`, 'utf8').trim();
      if (address) return address;
    } catch {
      // Not yet.
    }
    await sleep(100);
  }
  return assert.fail('the coordinator does not start');
}
process.on('exit', () => coordinator.kill('SIGKILL'));

process.env.HYADES_URL = await start('127.0.0.1:0');
const { at, finish, forgive, page, step, until, url } = await import('./page.mjs');
forgive(/status of 401|net::ERR_/);

async function signIn(text) {
  await at('token').fill(text);
  await at('dialog-in').click();
}

await step('who shows no token is asked for one, and a wrong one is told', async () => {
  await page.goto(`${url}/`);
  await at('sign-in').waitFor();
  assert.equal(await at('why-sign-in').count(), 0);
  await signIn('a-token-of-another-farm');
  await page.getByText('not a token of this coordinator').waitFor();
  await signIn(token);
  await at('sign-in').waitFor({ state: 'detached' });
  await until('it says who is signed in', async () => (await at('who').textContent()) === 'admin');
  assert.ok(await at('sign-out').isVisible());
});

await step('when the coordinator starts again the page says so, asks anew and goes on', async () => {
  await at('nav-workers').click();
  coordinator.kill('SIGKILL');
  await once(coordinator, 'exit');
  await start(new URL(url).host);
  await at('why-sign-in').waitFor();
  assert.match(await at('why-sign-in').textContent(), /^The session is over .*sign in again/);
  await signIn(token);
  await at('sign-in').waitFor({ state: 'detached' });
  await until('the farm is shown', async () => (await at('top-count').textContent()).includes('0 workers'));
  assert.match(page.url(), /workers/);
});

await step('who signs out is out, and sees nothing more', async () => {
  const before = await page.context().cookies();
  assert.equal(before.length, 1);
  assert.equal(before[0].name, `hyades_session_${new URL(url).port}`);
  await at('sign-out').click();
  await at('sign-in').waitFor();
  assert.equal((await page.context().cookies()).length, 0);
  assert.ok(!(await at('sign-out').isVisible()));
  const kept = `${before[0].name}=${before[0].value}`;
  assert.equal((await fetch(`${url}/api/v1/info`, { headers: { cookie: kept } })).status, 401, 'a cookie that was kept');
});

await finish();
// One that runs on would keep this process.
coordinator.kill('SIGKILL');
