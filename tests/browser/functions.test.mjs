// Functions of the page that need no browser: decoding, thinning, CSV, texts of axes.

import assert from "node:assert/strict";
import { test } from "node:test";

import { load } from "./load.mjs";

const { valuesOf, columnOf, unpack } = load(["decode.js"], ["valuesOf", "columnOf", "unpack"]);
const { perPixel, extremes, nearest, within, widened, reach } =
  load(["thin.js"], ["perPixel", "extremes", "nearest", "within", "widened", "reach"]);
const { csvOf, cell, fileName } = load(["csv.js"], ["csvOf", "cell", "fileName"]);
const { tick, shown } = load(["theme.js"], ["tick", "shown"]);

const f32 = (values) => ({ f32: Buffer.from(Float32Array.from(values).buffer).toString("base64") });
const even = (n, start = 0, step = 1) => columnOf({ even: { n, start, step } });

test("columns of every stored form become numbers", () => {
  assert.deepEqual([...valuesOf({ even: { n: 3, start: 2, step: 0.5 } })], [2, 2.5, 3]);
  assert.deepEqual([...valuesOf(f32([1.5, -2, NaN]))], [1.5, -2, NaN]);
  const codes = Buffer.from(Uint16Array.from([0, 65534, 65535, 32767]).buffer).toString("base64");
  const values = valuesOf({ u16: { low: -1, high: 3, codes } });
  assert.deepEqual([...values].slice(0, 3), [-1, 3, NaN]);
  assert.ok(Math.abs(values[3] - 1) < 1e-4);
});

test("a value is looked up in even and in uneven columns alike", () => {
  const uneven = columnOf(f32([0, 1, 2, 3]));
  for (const x of [even(4), uneven]) {
    assert.deepEqual([-1, 0, 0.5, 2.6, 3, 9].map((v) => x.from(v)), [0, 0, 1, 3, 3, 4]);
    assert.deepEqual([-1, 0.4, 0.6, 9].map((v) => nearest(x, v)), [0, 0, 1, 3]);
    assert.ok(x.rising);
  }
  assert.equal(columnOf(f32([0, 2, 1])).rising, false);
  assert.equal(nearest(columnOf(f32([5, 2, 9])), 3), 1);
  assert.deepEqual(within(even(100), 10.2, 20.5), [10, 22]);
  assert.deepEqual(within(even(100), -5, 500), [0, 100]);
});

test("a simulation is measured minus residual", () => {
  const items = [{ kind: "line", x: 0, y: 1, minus: 2 }, { kind: "level", at: 4 }];
  const [chart] = unpack({ columns: [{ even: { n: 2, start: 0, step: 1 } }, f32([3, 5]), f32([1, -1])], charts: [{ items }] });
  assert.deepEqual([...chart.items[0].y], [2, 6]);
  assert.equal(chart.items[0].key, 0);
});

test("per pixel, no extreme is lost and gaps stay gaps", () => {
  const n = 100000;
  const y = Float64Array.from({ length: n }, (_, k) => Math.sin(k / 50));
  y[43210] = 9;
  y[43211] = -9;
  for (let k = 70000; k < 80000; k++) y[k] = NaN;
  const pieces = perPixel(even(n), y, 0, n, (x) => x / 100);
  assert.equal(pieces.length, 2);
  const all = pieces.flat();
  assert.ok(all.length <= 2 * 4 * 1001 && all.includes(9) && all.includes(-9));
  const pixels = all.filter((_, i) => i % 2 === 0);
  assert.ok(pixels.every((p, i) => i === 0 || p >= pixels[i - 1]));
  assert.ok(!pixels.some((p) => p > 700 && p < 800));
  // first and last of a column are kept, so that the line enters and leaves it where it did
  assert.deepEqual(perPixel(even(4), [1, 3, 0, 2], 0, 4, () => 5), [[5, 1, 5, 3, 5, 0, 5, 2]]);
});

test("per pixel is fast enough to follow a hand", () => {
  const n = 1e6;
  const y = Float64Array.from({ length: n }, (_, k) => (k * 7919) % 1013);
  const started = performance.now();
  perPixel(even(n), y, 0, n, (x) => x / 1000);
  assert.ok(performance.now() - started < 500);
});

test("ranges: what is within, positive on a logarithmic axis, and never empty", () => {
  const item = { kind: "line", x: even(5), y: [5, -1, 2, 8, NaN] };
  assert.deepEqual(extremes(item, 1, 2, false), [-1, 2]);
  assert.deepEqual(extremes(item, 0, 9, true), [2, 8]);
  assert.equal(extremes(item, 4, 9, false), null);
  assert.deepEqual(extremes({ kind: "level", at: 3 }, 0, 1, false), [3, 3]);
  assert.deepEqual(extremes({ ...item, kind: "dots", z: [1, 0, 0, 0, 0] }, 0, 0, false), [4, 6]);
  assert.deepEqual(extremes({ ...item, kind: "band", z: [9, 9, 9, 9, 9] }, 0, 0, false), [5, 9]);
  assert.deepEqual(reach([item, { kind: "upright", at: 99 }], false), [0, 4]);
  assert.deepEqual(reach([item], true), [1, 4]);
  assert.deepEqual(widened([2, 2], 0.05, false), [1, 3]);
  assert.deepEqual(widened([0, 0], 0.05, false), [-0.5, 0.5]);
});

test("data are saved wide where lines share their x, long otherwise", () => {
  const chart = { x: { label: "time [s]" }, y: { label: "y, [m]" } };
  const line = (label, y) => ({ kind: "line", label, x: even(2), key: 0, y, z: null });
  chart.items = [line("measured", [1, 0.1 + 0.2]), line("", [NaN, -4])];
  assert.equal(csvOf(chart), 'time [s],measured,"y, [m]"\n0,1,\n1,0.3,-4\n');
  chart.items = [line("law", [1, 2]), { kind: "dots", label: "free", x: even(1), key: 7, y: [3], z: [0.5] },
    { kind: "level", label: "floor", at: 6 }];
  assert.equal(csvOf(chart), 'item,time [s],"y, [m]",half bar or upper bound\nlaw,0,1,\nlaw,1,2,\nfree,0,3,0.5\nfloor,,6,\n');
});

test("a name is neither a formula nor a path", () => {
  assert.equal(cell("=cmd|'/c calc'!A1"), "'=cmd|'/c calc'!A1");
  assert.equal(cell('a"b'), '"a""b"');
  assert.equal(fileName("../Residual of y: \u{202e} [m]"), "residual-of-y-m.csv");
  assert.equal(fileName("\u{5d0}"), "figure.csv");
});

test("numbers have as many digits as they need", () => {
  assert.deepEqual([0, 0.5, 1].map((v) => tick(v, 0.5)), ["0", "0.5", "1.0"]);
  assert.deepEqual([0.25, 0.5].map((v) => tick(v, 0.25)), ["0.25", "0.50"]);
  assert.equal(tick(-20, 10), "\u221220");
  assert.equal(tick(2e-5, 1e-5), "2e\u22125");
  assert.equal(tick(0.01, 0.01), "0.01");
  assert.equal(tick(1e6, 1e6), "1e6");
  assert.equal(shown(NaN), "\u2013");
  assert.equal(shown(-0.123456789), "\u22120.12346");
  assert.equal(shown(1.5e-7), "1.5000e\u22127");
});
