// Questions: modal, with the focus held and given back by the browser's own <dialog>.
import { h } from './dom.js';

/**
 * Shows a dialog; resolves with the value of the button that closed it, '' for Escape. `body`: nodes. `buttons`: [{value, text,
 * kind}], the last one answers Enter. `check(value)`: a promise; while it fails (throws) the dialog stays and says why.
 */
export function ask({ title, body = [], buttons, testid = 'dialog', check }) {
  return new Promise((resolve) => {
    const problem = h('p', { class: 'problem', role: 'alert' });
    const form = h(
      'form',
      { method: 'dialog', class: 'dialog-form' },
      h('h2', { id: 'dialog-title', text: title }),
      ...body,
      problem,
      h(
        'div',
        { class: 'buttons' },
        buttons.map(({ value, text, kind }, index) =>
          h('button', {
            type: index === buttons.length - 1 ? 'submit' : 'button',
            class: kind ?? '',
            text,
            testid: `dialog-${value || 'close'}`,
            onclick: index === buttons.length - 1 ? undefined : () => dialog.close(value),
          }),
        ),
      ),
    );
    const dialog = h('dialog', { 'aria-labelledby': 'dialog-title', testid }, form);
    form.addEventListener('submit', async (event) => {
      event.preventDefault();
      const { value } = buttons[buttons.length - 1];
      try {
        await check?.(value);
        dialog.close(value);
      } catch (error) {
        problem.textContent = error.message;
      }
    });
    dialog.addEventListener('close', () => {
      dialog.remove();
      resolve(dialog.returnValue);
    });
    dialog.addEventListener('click', (event) => {
      if (event.target === dialog) dialog.close('');
    });
    document.body.append(dialog);
    dialog.showModal();
    (form.querySelector('[autofocus]') ?? form.querySelector('.buttons button:last-child')).focus();
  });
}

/** Closes all questions, as Escape does: another page is shown. */
export function closeDialogs() {
  for (const dialog of document.querySelectorAll('dialog[open]')) dialog.close('');
}

/** Asks before something happens; true where it is to. */
export async function confirm({ title, body, action, danger = false }) {
  const answer = await ask({
    title,
    body,
    testid: 'confirm',
    buttons: [
      { value: '', text: 'Keep as it is' },
      { value: 'yes', text: action, kind: danger ? 'danger' : 'primary' },
    ],
  });
  return answer === 'yes';
}
