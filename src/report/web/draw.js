// Items of a chart onto a canvas.

/**
 * Where things lie: `x` and `y` give the pixel of a value.
 * @typedef {Object} Frame
 * @property {CanvasRenderingContext2D} ctx
 * @property {(v: number) => number} x
 * @property {(v: number) => number} y
 * @property {{left: number, top: number, width: number, height: number}} box
 * @property {[number, number]} view   range along x
 * @property {number} ratio            canvas pixels per pixel of the page
 * @property {boolean} logX
 * @property {boolean} logY
 */

/** The place of a value between two ends of an axis, in pixels. */
function placer(low, high, from, to, log) {
  if (log) {
    const [a, b] = [Math.log(low), Math.log(high)];
    return (v) => (v > 0 ? from + ((Math.log(v) - a) / (b - a)) * (to - from) : NaN);
  }
  return (v) => from + ((v - low) / (high - low)) * (to - from);
}

/** Draws one item. */
function drawItem(frame, item, colour, look) {
  const { ctx, ratio } = frame;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = colour;
  ctx.lineWidth = look.width * ratio;
  ctx.lineJoin = "round";
  ctx.setLineDash(look.dash.map((d) => d * ratio));
  ctx.globalAlpha = look.alpha;
  if (item.kind === "line") drawLine(frame, item, look);
  else if (item.kind === "band") drawBand(frame, item);
  else if (item.kind === "dots") drawDots(frame, item);
  else drawRule(frame, item);
  ctx.restore();
}

function drawLine(frame, item, look) {
  const { ctx, box, ratio } = frame;
  const [from, to] = within(item.x, ...frame.view);
  const many = item.x.rising && to - from > 4 * box.width;
  ctx.beginPath();
  if (many) {
    for (const piece of perPixel(item.x, item.y, from, to, frame.x)) {
      ctx.moveTo(piece[0], frame.y(piece[1]));
      for (let i = 2; i < piece.length; i += 2) ctx.lineTo(piece[i], frame.y(piece[i + 1]));
    }
    // a dash pattern along a line that fills a band cannot be seen, and costs most of the time
    ctx.setLineDash([]);
    ctx.lineWidth = Math.min(ctx.lineWidth, 1.4 * ratio);
    ctx.stroke();
    return;
  }
  let down = false;
  for (let k = from; k < to; k++) {
    const [x, y] = [frame.x(item.x.at(k)), frame.y(item.y[k])];
    if (!Number.isFinite(x) || !Number.isFinite(y)) down = false;
    else if (down) ctx.lineTo(x, y);
    else {
      ctx.moveTo(x, y);
      down = true;
    }
  }
  if (to - from > box.width / ratio) ctx.setLineDash([]);
  ctx.stroke();
  // single samples, where they lie far enough apart to be seen as such
  const apart = box.width / ratio / Math.max(1, to - from);
  if (look.marker && apart > 7) {
    ctx.globalAlpha = 1;
    for (let k = from; k < to; k++) dot(ctx, frame.x(item.x.at(k)), frame.y(item.y[k]), look.marker * ratio);
  }
}

function drawBand(frame, item) {
  const { ctx } = frame;
  ctx.beginPath();
  for (let k = 0; k < item.x.n; k++) ctx.lineTo(frame.x(item.x.at(k)), frame.y(item.z[k]));
  for (let k = item.x.n - 1; k >= 0; k--) ctx.lineTo(frame.x(item.x.at(k)), frame.y(item.y[k]));
  ctx.globalAlpha = 0.2;
  ctx.fill();
}

function drawDots(frame, item) {
  const { ctx, ratio } = frame;
  ctx.setLineDash([]);
  ctx.lineWidth = 1.3 * ratio;
  for (let k = 0; k < item.x.n; k++) {
    const [x, y] = [frame.x(item.x.at(k)), frame.y(item.y[k])];
    const half = item.z ? item.z[k] : 0;
    if (half > 0) {
      const [low, high] = [item.y[k] - half, item.y[k] + half].map((v) =>
        frame.logY && v <= 0 ? frame.box.top + frame.box.height : frame.y(v));
      ctx.beginPath();
      ctx.moveTo(x, low);
      ctx.lineTo(x, high);
      ctx.stroke();
    }
    dot(ctx, x, y, 3.2 * ratio);
  }
}

function drawRule(frame, item) {
  const { ctx, box } = frame;
  ctx.beginPath();
  if (item.kind === "level") {
    const y = frame.y(item.at);
    ctx.moveTo(box.left, y);
    ctx.lineTo(box.left + box.width, y);
  } else {
    const x = frame.x(item.at);
    ctx.moveTo(x, box.top);
    ctx.lineTo(x, box.top + box.height);
  }
  ctx.stroke();
}

function dot(ctx, x, y, radius) {
  if (!Number.isFinite(x) || !Number.isFinite(y)) return;
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.fill();
}

/** Draws how an item looks onto the small canvas (56 x 24) of its entry in the legend. */
function drawSample(ctx, item, colour) {
  ctx.clearRect(0, 0, 56, 24);
  const box = { left: 2, top: 0, width: 52, height: 24 };
  const frame = { ctx, box, ratio: 2, x: (v) => 2 + 52 * v, y: (v) => 12 - 8 * v, view: [0, 1] };
  const x = { n: 2, at: (k) => k, rising: true, from: (v) => Math.max(0, Math.min(2, Math.ceil(v))) };
  const sample = { ...item, x, y: [0, 0], at: 0, z: null };
  if (item.kind === "band") [sample.y, sample.z] = [[-1, -1], [1, 1]];
  if (item.kind === "dots") sample.x = { ...x, n: 1, at: () => 0.5 };
  if (item.kind === "upright") sample.kind = "level";
  drawItem(frame, sample, colour, { ...LOOKS[item.role], marker: 0 });
}
