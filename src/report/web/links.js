// What figures share: the range along x and what is switched on; and the strip that shows a
// whole record with the range marked.

/** Links charts of one group. */
function link(charts) {
  for (const chart of charts) {
    chart.onView = (view) => {
      for (const other of charts) if (other !== chart) other.show(view, false);
      charts.strip?.mark();
    };
    chart.onToggle = (label, on) => {
      for (const other of charts) {
        if (other === chart) continue;
        other.spec.items.forEach((item, i) => {
          if (item.label === label && other.on[i] !== on) other.toggle(i, on);
        });
      }
      charts.strip?.draw();
    };
  }
  // one range for all: figures of one link reach over the same record
  const low = Math.min(...charts.map((chart) => chart.whole[0]));
  const high = Math.max(...charts.map((chart) => chart.whole[1]));
  for (const chart of charts) chart.whole = [low, high];
  const shown = charts.find((chart) => chart.spec.overview);
  if (shown) charts.strip = new Strip(charts[0], shown);
}

/** A strip that shows a chart whole, with the range that is shown marked. */
class Strip {
  /**
   * @param {Chart} host  the chart above which it stands
   * @param {Chart} of    the chart that it shows
   */
  constructor(host, of) {
    this.host = host;
    this.of = of;
    this.box = document.createElement("div");
    this.box.className = "strip";
    this.box.setAttribute("aria-hidden", "true");
    this.canvas = add(this.box, "canvas", "");
    this.window = add(this.box, "div", "window");
    host.figure.insertBefore(this.box, host.plot);
    add(this.box, "span", "remark", `${of.spec.title}, whole: drag the window`);
    this.drags();
    this.draw();
  }

  drags() {
    let grip = null;
    const at = (event) => {
      const box = this.box.getBoundingClientRect();
      const [low, high] = this.host.whole;
      return low + ((event.clientX - box.left) / box.width) * (high - low);
    };
    const centre = (to) => {
      const half = (this.host.view[1] - this.host.view[0]) / 2;
      this.host.show([to - half, to + half]);
    };
    this.box.addEventListener("pointerdown", (event) => {
      const middle = (this.host.view[0] + this.host.view[1]) / 2;
      const inside = event.target === this.window;
      grip = inside ? middle - at(event) : 0;
      this.box.setPointerCapture(event.pointerId);
      if (!inside) centre(at(event));
    });
    this.box.addEventListener("pointermove", (event) => {
      if (grip !== null) centre(at(event) + grip);
    });
    for (const name of ["pointerup", "pointercancel"]) {
      this.box.addEventListener(name, () => (grip = null));
    }
  }

  draw() {
    const ratio = devicePixelRatio || 1;
    const [width, height] = [this.box.clientWidth * ratio, this.box.clientHeight * ratio];
    if (!width) return;
    [this.canvas.width, this.canvas.height] = [width, height];
    const ctx = this.canvas.getContext("2d");
    const chart = this.of;
    let [low, high] = [Infinity, -Infinity];
    chart.spec.items.forEach((item, i) => {
      const range = chart.on[i] ? extremes(item, ...chart.whole, false) : null;
      if (range) [low, high] = [Math.min(low, range[0]), Math.max(high, range[1])];
    });
    if (low <= high) {
      [low, high] = widened([low, high], 0.05, false);
      const box = { left: 0, top: 0, width, height };
      const [a, b] = this.host.whole;
      const frame = { ctx, box, ratio, x: placer(a, b, 0, width, false), y: placer(low, high, height, 0, false), view: [a, b] };
      chart.spec.items.forEach((item, i) => {
        if (chart.on[i] && item.kind === "line") drawItem(frame, item, chart.colours[item.role], { ...LOOKS[item.role], width: 1 });
      });
    }
    this.mark();
  }

  mark() {
    const [a, b] = this.host.whole;
    const [low, high] = this.host.view;
    this.window.style.left = `${(100 * (low - a)) / (b - a)}%`;
    this.window.style.width = `${Math.max(0.4, (100 * (high - low)) / (b - a))}%`;
  }
}
