// What of a long series a picture shows: per pixel, and over a range.

/**
 * Indices [from, to) of a rising column within [low, high], one more on either side, so that
 * a line goes on to the edge of the picture.
 */
function within(x, low, high) {
  if (!x.rising) return [0, x.n];
  const from = Math.max(0, x.from(low) - 1);
  let to = x.from(high);
  while (to < x.n && x.at(to) <= high) to++;
  return [from, Math.min(x.n, to + 1)];
}

/**
 * First, smallest, largest and last value of every pixel column, which draws the same line as
 * all values would (M4: Jugel, Jerzak, Hackenbroich, Markl, Proceedings of the VLDB Endowment
 * 7(10), 2014).
 *
 * @param {Column} x         a rising column
 * @param {ArrayLike<number>} y
 * @param {number} from      first index
 * @param {number} to        one beyond the last
 * @param {(v: number) => number} pixel  place of an x, in pixels
 * @returns {number[][]} pieces without a gap, each [pixel, value, pixel, value, ..]
 */
function perPixel(x, y, from, to, pixel) {
  const pieces = [];
  let piece = null;
  let at = null;
  let first = 0, last = 0, low = 0, high = 0, lowAt = 0, highAt = 0;
  const flush = () => {
    if (at === null) return;
    const kept = [first];
    if (lowAt <= highAt) kept.push(low, high);
    else kept.push(high, low);
    kept.push(last);
    let before = NaN;
    for (const value of kept) {
      if (value !== before) piece.push(at, value);
      before = value;
    }
    at = null;
  };
  for (let k = from; k < to; k++) {
    const value = y[k];
    if (!Number.isFinite(value)) {
      flush();
      piece = null;
      continue;
    }
    const here = Math.round(pixel(x.at(k)));
    if (here !== at || !piece) {
      flush();
      if (!piece) pieces.push((piece = []));
      at = here;
      first = last = low = high = value;
      lowAt = highAt = k;
      continue;
    }
    last = value;
    if (value < low) [low, lowAt] = [value, k];
    if (value > high) [high, highAt] = [value, k];
  }
  flush();
  return pieces;
}

/**
 * Smallest and largest value of an item within [low, high] along x; null where there is none.
 * With `log`, values that are not positive do not count.
 */
function extremes(item, low, high, log) {
  let [min, max] = [Infinity, -Infinity];
  const take = (v) => {
    if (!Number.isFinite(v) || (log && v <= 0)) return;
    if (v < min) min = v;
    if (v > max) max = v;
  };
  if (item.kind === "level") take(item.at);
  else if (item.kind !== "upright") {
    const { x, y, z } = item;
    let [from, to] = x.rising ? [x.from(low), within(x, low, high)[1]] : [0, x.n];
    while (x.rising && to > from && x.at(to - 1) > high) to--;
    const spread = item.kind === "dots" ? z : null;
    for (let k = from; k < to; k++) {
      if (!x.rising && (x.at(k) < low || x.at(k) > high)) continue;
      const v = y[k];
      // most values of a long record are neither, and are done with here
      if (v <= max && v >= min && !z) continue;
      take(v);
      if (item.kind === "band") take(z[k]);
      if (spread && spread[k] > 0) {
        take(v - spread[k]);
        take(v + spread[k]);
      }
    }
  }
  return min <= max ? [min, max] : null;
}

/** A range with a margin of a share of it on both sides, never empty. */
function widened([low, high], share, log) {
  if (log) {
    const ratio = Math.max((high / low) ** share, 1 + 2 * share);
    return [low / ratio, high * ratio];
  }
  if (high === low) {
    const half = high === 0 ? 0.5 : 0.5 * Math.abs(high);
    return [low - half, high + half];
  }
  return [low - share * (high - low), high + share * (high - low)];
}

/** Index of the value of a rising column that is nearest to v; -1 where the column is empty. */
function nearest(x, v) {
  if (x.n === 0) return -1;
  if (!x.rising) {
    let best = 0;
    for (let k = 1; k < x.n; k++) {
      if (Math.abs(x.at(k) - v) < Math.abs(x.at(best) - v)) best = k;
    }
    return best;
  }
  const k = x.from(v);
  if (k === 0) return 0;
  if (k === x.n) return x.n - 1;
  return v - x.at(k - 1) <= x.at(k) - v ? k - 1 : k;
}

/** Figures of an axis: how far they reach along x over all items; null where nothing is drawn. */
function reach(items, log) {
  let [low, high] = [Infinity, -Infinity];
  for (const item of items) {
    if (item.kind === "level" || item.kind === "upright") continue;
    for (let k = 0; k < item.x.n; k++) {
      const v = item.x.at(k);
      if (!Number.isFinite(v) || (log && v <= 0)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
  }
  return low <= high ? [low, high] : null;
}
