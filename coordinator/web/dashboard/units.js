// What a job's timeline says, counted: by worker and by tile.

const MOST_LANES = 8;

/**
 * Units by worker, those that overlap in lanes: [{worker, units: [{unit, lane}], lanes, busy (seconds in which it
 * had a unit), work (seconds, summed over units), count}], workers by name.
 */
export function byWorker(units) {
  const rows = new Map();
  for (const unit of [...units].sort((a, b) => a.begun_ms - b.begun_ms)) {
    let row = rows.get(unit.worker);
    if (!row)
      rows.set(unit.worker, (row = { worker: unit.worker, units: [], ends: [], busy: 0, work: 0, count: 0, until: 0 }));
    let lane = row.ends.findIndex((end) => end <= unit.begun_ms);
    if (lane < 0) lane = row.ends.length < MOST_LANES ? row.ends.length : row.ends.indexOf(Math.min(...row.ends));
    row.ends[lane] = unit.ended_ms;
    row.units.push({ unit, lane });
    row.busy += Math.max(0, unit.ended_ms - Math.max(unit.begun_ms, row.until)) / 1000;
    row.until = Math.max(row.until, unit.ended_ms);
    row.work += (unit.ended_ms - unit.begun_ms) / 1000;
    ++row.count;
  }
  return [...rows.values()]
    .map(({ worker, units: of, ends, busy, work, count }) => ({
      worker,
      units: of,
      lanes: ends.length,
      busy,
      work,
      count,
    }))
    .sort((a, b) => a.worker.localeCompare(b.worker, 'en', { numeric: true }));
}

/** Seconds that each tile took, over all batches: [{tile, seconds, batches}]. */
export function byTile(units) {
  const tiles = new Map();
  for (const { tile, batches, begun_ms: begun, ended_ms: ended } of units) {
    const key = tile.join();
    let entry = tiles.get(key);
    if (!entry) tiles.set(key, (entry = { tile, seconds: 0, batches: 0 }));
    entry.seconds += (ended - begun) / 1000;
    entry.batches += batches;
  }
  return [...tiles.values()];
}
