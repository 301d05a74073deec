// Columns of numbers as a page carries them, back to numbers. See src/report/column.rs.

/**
 * A column of numbers along which one can look a value up.
 * @typedef {Object} Column
 * @property {number} n          number of values
 * @property {(k: number) => number} at   value of index k
 * @property {boolean} rising    whether no value is smaller than the one before it
 * @property {(v: number) => number} from  first index whose value is not below v (rising columns)
 */

/** Bytes of a base64 text. */
function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Values of a stored column as an array. */
function valuesOf(stored) {
  if (stored.even) {
    const { n, start, step } = stored.even;
    return Float64Array.from({ length: n }, (_, k) => start + k * step);
  }
  if (stored.f32 !== undefined) {
    const bytes = bytesOf(stored.f32);
    const view = new DataView(bytes.buffer);
    const values = new Float64Array(bytes.length >> 2);
    for (let k = 0; k < values.length; k++) values[k] = view.getFloat32(4 * k, true);
    return values;
  }
  const { low, high, codes } = stored.u16;
  const bytes = bytesOf(codes);
  const values = new Float64Array(bytes.length >> 1);
  const step = (high - low) / 65534;
  for (let k = 0; k < values.length; k++) {
    const code = bytes[2 * k] | (bytes[2 * k + 1] << 8);
    values[k] = code === 65535 ? NaN : low + code * step;
  }
  return values;
}

/**
 * A stored column, ready to be looked up.
 * @returns {Column}
 */
function columnOf(stored) {
  if (stored.even) {
    const { n, start, step } = stored.even;
    return {
      n,
      at: (k) => start + k * step,
      rising: step > 0,
      from: (v) => Math.min(n, Math.max(0, Math.ceil((v - start) / step - 1e-9))),
    };
  }
  const values = valuesOf(stored);
  let rising = true;
  for (let k = 1; k < values.length; k++) {
    if (!(values[k] >= values[k - 1])) rising = false;
  }
  const from = (v) => {
    let [low, high] = [0, values.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[middle] < v) low = middle + 1;
      else high = middle;
    }
    return low;
  };
  return { n: values.length, at: (k) => values[k], rising, from };
}

/** a - b, value by value; a where there is no b. */
function difference(a, b) {
  return b ? a.map((v, k) => v - b[k]) : a;
}

/**
 * Gives every item of every chart its columns `x` (looked up), `y` and `z` (values).
 * @param {{columns: Object[], charts: Object[]}} data
 */
function unpack(data) {
  const values = data.columns.map(() => null);
  const get = (i) => (values[i] ??= valuesOf(data.columns[i]));
  for (const chart of data.charts) {
    for (const item of chart.items) {
      if (item.x === undefined) continue;
      item.key = item.x;
      item.x = columnOf(data.columns[item.x]);
      item.y = difference(get(item.y), item.minus === undefined ? null : get(item.minus));
      item.z = item.z === undefined ? null : get(item.z);
    }
  }
  return data.charts;
}
