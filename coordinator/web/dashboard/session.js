// Signing in, where the coordinator has a token.
import { ask } from './dialog.js';
import { onSignedOut, signIn } from './api.js';
import { h } from './dom.js';
import { learnMe } from './me.js';

let asking = false;

async function askForToken() {
  if (asking) return;
  asking = true;
  const field = h('input', {
    type: 'password',
    name: 'token',
    autocomplete: 'current-password',
    required: true,
    autofocus: true,
    testid: 'token',
    'aria-describedby': 'token-hint',
  });
  for (;;) {
    const answer = await ask({
      title: 'Sign in',
      testid: 'sign-in',
      body: [
        h('p', {
          id: 'token-hint',
          text: 'This farm asks for a token: one line of text, which an admin makes (hyades token create).',
        }),
        h('label', { class: 'field' }, 'Token', field),
      ],
      buttons: [{ value: 'in', text: 'Sign in', kind: 'primary' }],
      check: () => signIn(field.value.trim()),
    });
    if (answer === 'in') break;
  }
  asking = false;
  await learnMe();
  dispatchEvent(new Event('hyades-signed-in'));
}

/** From now on whoever is told to sign in is asked for the token. */
export function startSession() {
  onSignedOut(askForToken);
  return learnMe();
}
