// Of rows that are known the coordinator tells only what has changed (openapi.yaml, FarmChange).

/**
 * The row with what has changed of it; null stands for a field that is gone. Undefined where it is not known and `change` is not all of it:
 * a row that was dropped here before the coordinator heard of that.
 */
export function changedRow(row, change) {
  if (!row && change.state === undefined) return undefined;
  const now = { ...row, ...change };
  for (const name in change) if (change[name] === null) delete now[name];
  return now;
}
