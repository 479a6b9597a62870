// Signing in, where the coordinator has a token.
import { ask } from './dialog.js';
import { onSignedOut, signIn, signOut } from './api.js';
import { h, setText } from './dom.js';
import { learnMe, me, onMe } from './me.js';

let asking = false;

/** `why`: the coordinator's words; told where they say what became of a session or token that was there. */
async function askForToken(why = '') {
  if (asking) return;
  asking = true;
  const had = /^the (session|token) /.test(why);
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
        had ? h('p', { text: `${why[0].toUpperCase()}${why.slice(1)}.`, testid: 'why-sign-in' }) : null,
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

/** A button that ends the session, here and at the coordinator; it is there where somebody is signed in. */
export function signOutButton() {
  const button = h('button', {
    type: 'button',
    class: 'plain small',
    text: 'Sign out',
    hidden: true,
    testid: 'sign-out',
    onclick: async () => {
      try {
        await signOut();
      } catch (error) {
        setText(button, error.message);
        return;
      }
      location.reload(); // nothing that they have seen stays
    },
  });
  onMe(() => {
    button.hidden = !me.guarded;
  });
  return button;
}

/** From now on whoever is told to sign in is asked for the token. */
export function startSession() {
  onSignedOut(askForToken);
  return learnMe();
}
