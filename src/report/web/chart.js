// One interactive figure: uPlot draws axes and the cursor, draw.js what stands between them.

/** Width of the axis along y, the same for all figures so that linked ones stand in line. */
const AXIS = { wide: 70, narrow: 62 };

class Chart {
  /**
   * @param {HTMLElement} figure  the `<figure>` of the page
   * @param {Object} spec         its chart, unpacked
   * @param {?[number, number]} view  range along x to begin with; all where there is none
   */
  constructor(figure, spec, view) {
    this.figure = figure;
    this.spec = spec;
    this.logX = spec.x.scale === "log";
    this.logY = spec.y.scale === "log";
    this.on = spec.items.map((item) => !item.off);
    const whole = reach(spec.items, this.logX) ?? [0, 1];
    const dots = spec.items.some((item) => item.kind === "dots");
    this.whole = spec.x.names?.length
      ? [0.5, spec.x.names.length + 0.5]
      : widened(whole, dots ? 0.02 : 0, this.logX);
    this.view = this.begun = view ?? this.whole;
    this.touched = false;
    /** Told when the range or what is switched on changes: links.js. */
    this.onView = this.onToggle = () => {};
    this.build();
  }

  /** Makes the elements: legend, tools, plot. */
  build() {
    const { figure, spec } = this;
    this.legend = add(figure, "div", "legend");
    this.position = add(this.legend, "span", "position");
    this.entries = entriesOf(this);
    this.plot = add(figure, "div", "plot");
    this.plot.tabIndex = 0;
    this.plot.setAttribute("role", "group");
    this.plot.setAttribute("aria-label", `${spec.title}. ${this.inWords()} Arrow keys read values, ` +
      "with shift they move the range; plus and minus zoom; 0 shows all.");
    this.said = add(figure, "p", "unseen");
    this.said.setAttribute("aria-live", "polite");
    this.tools = add(figure, "div", "tools");
    for (const [text, name, act] of [
      ["+", "Zoom in", () => this.zoom(0.5)],
      ["\u2212", "Zoom out", () => this.zoom(2)],
      ["\u2190", "Earlier", () => this.move(-0.5)],
      ["\u2192", "Later", () => this.move(0.5)],
      ["All", "Show all", () => this.show(this.whole)],
      ["Save CSV", "Save the data of this figure as CSV", () => save(fileName(spec.title), csvOf(spec))],
    ]) {
      const button = add(this.tools, "button", "", text);
      button.type = "button";
      button.title = name;
      if (text.length === 1) button.setAttribute("aria-label", name);
      button.addEventListener("click", act);
    }
    if (spec.thinned) {
      add(this.tools, "span", "remark", `smallest and largest of every ${spec.thinned} samples`);
    }
    this.draw();
    gestures(this);
  }

  /** What the figure holds, for those who cannot see it. */
  inWords() {
    const parts = this.spec.items.filter((item) => item.label && item.x).map((item) => {
      const range = extremes(item, -Infinity, Infinity, this.logY);
      return range ? `${item.label}: ${item.x.n} points from ${shown(range[0])} to ${shown(range[1])}` : item.label;
    });
    return `${this.spec.x.label} from ${shown(this.whole[0])} to ${shown(this.whole[1])}. ${parts.join("; ")}.`;
  }

  /** Draws everything anew: at first, for another width, other colours. */
  draw() {
    const colours = (this.colours = palette(this.figure));
    const width = Math.max(240, this.plot.clientWidth);
    const narrow = width < 520;
    const font = "12px system-ui, sans-serif";
    const height = this.spec.height + (narrow ? -20 : 20);
    const axis = (label, along) => ({
      label,
      labelSize: 18,
      labelGap: 0,
      // a long label on a short axis is set smaller before it is cut off
      labelFont: `${Math.max(9, Math.min(13, along / (0.56 * label.length))).toFixed(1)}px system-ui, sans-serif`,
      font,
      stroke: colours.ink,
      grid: { stroke: colours.rule, width: 1 },
      ticks: { stroke: colours.rule, width: 1, size: 4 },
    });
    const ticks = (u, splits) => {
      const seen = splits.filter((v) => v !== null);
      const step = seen.length > 1 ? Math.abs(seen[1] - seen[0]) : 1;
      return splits.map((v) => (v === null ? null : tick(v, step)));
    };
    const powers = (u, splits) => splits.map((v) => (v === null ? null : tick(v, v)));
    const names = this.spec.x.names;
    const x = { ...axis(this.spec.x.label, width), size: 30 };
    if (names?.length) {
      x.splits = () => names.map((_, i) => i + 1);
      x.values = () => names.map((name) => (narrow ? name.slice(0, 9) : name));
    } else x.values = this.logX ? powers : ticks;
    const y = { ...axis(this.spec.y.label, height - 56), size: narrow ? AXIS.narrow - 18 : AXIS.wide - 18, gap: 3 };
    // a low figure has room for more than one number as well
    if (this.spec.height < 160) y.space = 18;
    y.values = this.logY ? powers : ticks;
    const options = {
      width,
      height,
      legend: { show: false },
      padding: [8, 18, 0, 0],
      cursor: {
        points: { show: false },
        drag: { x: true, y: false, setScale: false, dist: 4 },
        bind: {
          mousedown: (u, target, act) => (event) => (event.shiftKey ? null : act(event)),
          dblclick: () => () => (this.show(this.whole), null),
        },
        // linked figures follow the cursor; ranges they follow by links.js
        sync: this.spec.link ? { key: this.spec.link, setSeries: false, filters: { sub: follows } } : undefined,
      },
      scales: {
        // ranges are those that are asked for, not whole decades
        x: { time: false, distr: this.logX ? 3 : 1, auto: false, range: (u, low, high) => [low, high] },
        y: { distr: this.logY ? 3 : 1, auto: false, range: (u, low, high) => [low, high] },
      },
      axes: [x, y],
      series: [{}, { show: true, paths: () => null, points: { show: false } }],
      hooks: {
        draw: [(u) => this.paint(u)],
        setCursor: [(u) => this.read(u)],
        setSelect: [(u) => this.select(u)],
      },
    };
    const data = [this.whole, [1, 1]];
    this.u?.destroy();
    this.u = new uPlot(options, data, this.plot);
    this.u.over.setAttribute("aria-hidden", "true");
    drawMarks(this);
    this.apply();
  }

  /** Draws the items between the axes. */
  paint(u) {
    const { ctx } = u;
    const box = u.bbox;
    const { min: low, max: high } = u.scales.x;
    const { min: bottom, max: top } = u.scales.y;
    const frame = {
      ctx,
      box,
      ratio: devicePixelRatio || 1,
      x: placer(low, high, box.left, box.left + box.width, this.logX),
      y: placer(bottom, top, box.top + box.height, box.top, this.logY),
      view: [low, high],
      logX: this.logX,
      logY: this.logY,
    };
    ctx.save();
    ctx.beginPath();
    ctx.rect(box.left, box.top, box.width, box.height);
    ctx.clip();
    this.spec.items.forEach((item, i) => {
      if (this.on[i]) drawItem(frame, item, this.colours[item.role], LOOKS[item.role]);
    });
    ctx.restore();
    this.figure.dataset.drawn = "yes";
    this.figure.dataset.range = `${low} ${high}`;
  }

  /** Sets the ranges: the view along x, and along y what is switched on and within it. */
  apply() {
    let [low, high] = [Infinity, -Infinity];
    this.spec.items.forEach((item, i) => {
      const range = this.on[i] ? extremes(item, ...this.view, this.logY) : null;
      if (range) [low, high] = [Math.min(low, range[0]), Math.max(high, range[1])];
    });
    const [bottom, top] = low <= high ? widened([low, high], 0.05, this.logY) : this.logY ? [1, 10] : [-1, 1];
    this.u.batch(() => {
      this.u.setScale("x", { min: this.view[0], max: this.view[1] });
      this.u.setScale("y", { min: bottom, max: top });
    });
    this.figure.dataset.view = this.view.join(" ");
  }

  /** Shows a range along x, and has linked figures show it. */
  show(view, linked = true) {
    const [low, high] = this.clamped(view);
    this.view = [low, high];
    this.touched ||= low !== this.begun[0] || high !== this.begun[1];
    this.apply();
    if (linked) this.onView(this.view);
  }

  /** A range within the whole, and wide enough to be drawn. */
  clamped([low, high]) {
    const [a, b] = this.whole;
    if (!(low < high)) return [a, b];
    if (this.logX) return [Math.max(a, low), Math.min(b, high)];
    const width = Math.min(b - a, Math.max(high - low, 1e-9 * (b - a)));
    const from = Math.min(Math.max(low, a), b - width);
    return [from, from + width];
  }

  /** Widens the range by a factor about a value (the middle where none is given). */
  zoom(factor, about) {
    const [low, high] = this.ends();
    const at = about === undefined ? (low + high) / 2 : this.logX ? Math.log(about) : about;
    this.show(this.values([at + (low - at) * factor, at + (high - at) * factor]));
  }

  /** Moves the range by a share of it. */
  move(share) {
    const [low, high] = this.ends();
    this.show(this.values([low + share * (high - low), high + share * (high - low)]));
  }

  /** Ends of the range as they lie along the axis, and back. */
  ends() {
    return this.logX ? this.view.map(Math.log) : this.view;
  }
  values(ends) {
    return this.logX ? ends.map(Math.exp) : ends;
  }

  /** Zooms to what was marked with the pointer. */
  select(u) {
    const { left, width } = u.select;
    if (width < 4) return;
    const view = [u.posToVal(left, "x"), u.posToVal(left + width, "x")];
    u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    this.show(view);
  }

  /** Switches an item on or off. */
  toggle(i, on) {
    this.on[i] = on;
    this.entries[i]?.button.setAttribute("aria-pressed", String(on));
    this.touched = true;
    this.apply();
  }

  /** Writes the values at the cursor into the legend. */
  read(u) {
    const { left } = u.cursor;
    if (left === null || left < 0) {
      this.position.textContent = "";
      this.entries.forEach((entry) => entry && (entry.value.textContent = ""));
      return "";
    }
    const at = u.posToVal(left, "x");
    const words = [];
    this.position.textContent = `${this.spec.x.label} ${shown(at)}`;
    this.spec.items.forEach((item, i) => {
      const entry = this.entries[i];
      if (!entry || !item.x) return;
      const k = nearest(item.x, at);
      const bar = item.kind === "dots" && item.z?.[k] > 0 ? ` \u00b1 ${shown(item.z[k])}` : "";
      const text = item.kind === "band" ? `${shown(item.y[k])} to ${shown(item.z[k])}` : shown(item.y[k]) + bar;
      entry.value.textContent = text;
      if (this.on[i]) words.push(`${item.label} ${text}`);
    });
    return `${this.spec.x.label} ${shown(at)}: ${words.join(", ")}`;
  }
}

/** Whether a linked figure does the same on an event of another. */
function follows(type) {
  return type === "mousemove" || type === "mouseleave";
}

/** Adds an element. */
function add(parent, tag, name, text) {
  const element = document.createElement(tag);
  if (name) element.className = name;
  if (text) element.textContent = text;
  parent.append(element);
  return element;
}
