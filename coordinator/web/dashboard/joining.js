// How a worker joins this farm, as its page can tell.

/**
 * The command, and where it is to be typed. `address`: HOST:PORT that the coordinator listens on; `page`: {hostname,
 * secure} of this page; `guarded`: callers need a token.
 */
export function joining(address, page, guarded) {
  const [, host, port] = /^(.*):(\d+)$/.exec(address || '') ?? [null, '', '7700'];
  const loopback = (name) => /^(localhost|127\.[\d.]+|\[?::1\]?)$/.test(name);
  const here = loopback(host);
  const everywhere = host === '' || host === '0.0.0.0' || host === '[::]';
  // Who looks through a tunnel does not know the farm's name.
  const name = !everywhere ? host : loopback(page.hostname) || !page.hostname ? 'HOST' : page.hostname;
  const words = ['hyades worker'];
  if (!here || port !== '7700') words.push(`--coordinator ${name}:${port}`);
  if (page.secure) words.push('--tls-ca ca.pem');
  if (guarded) words.push('--token-file worker.token');
  return {
    command: words.join(' '),
    where: here
      ? 'On the coordinator’s machine, the only one that this farm listens to:'
      : 'On each machine that is to render:',
  };
}
