// Keys, wheel, dragging with shift, and touch.

/** Binds all of them to a chart. */
function gestures(chart) {
  keys(chart);
  wheel(chart);
  drags(chart);
}

/** Moves the reading cursor by pixels and says the values. */
function readAt(chart, by) {
  const { u } = chart;
  const width = u.over.clientWidth;
  const from = u.cursor.left >= 0 ? u.cursor.left : width / 2;
  const left = Math.min(width, Math.max(0, from + by));
  u.setCursor({ left, top: u.over.clientHeight / 2 });
  chart.said.textContent = chart.read(u);
}

function keys(chart) {
  const step = (event, sign) => {
    if (event.shiftKey) chart.move(0.2 * sign);
    else readAt(chart, (event.ctrlKey ? 25 : 4) * sign);
  };
  const acts = {
    ArrowLeft: (event) => step(event, -1),
    ArrowRight: (event) => step(event, 1),
    "+": () => chart.zoom(0.5),
    "=": () => chart.zoom(0.5),
    "-": () => chart.zoom(2),
    0: () => chart.show(chart.whole),
    Home: () => chart.show(chart.whole),
    Escape: () => chart.show(chart.whole),
  };
  chart.plot.addEventListener("keydown", (event) => {
    const act = event.altKey || event.metaKey ? null : acts[event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}

/** With ctrl (and by pinching a touch pad) the wheel zooms, sideways or with shift it moves. */
function wheel(chart) {
  chart.plot.addEventListener("wheel", (event) => {
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY) ? event.deltaX : event.shiftKey ? event.deltaY : 0;
    if (event.ctrlKey) {
      const left = event.clientX - chart.u.over.getBoundingClientRect().left;
      chart.zoom(1.0015 ** event.deltaY, chart.u.posToVal(left, "x"));
    } else if (sideways) chart.move(sideways / chart.u.over.clientWidth);
    else return;
    event.preventDefault();
  }, { passive: false });
}

/** With shift the mouse moves the range, one finger moves it, two zoom. */
function drags(chart) {
  const held = new Map();
  let before = null;
  const now = () => {
    const at = [...held.values()];
    return { middle: at.reduce((a, b) => a + b, 0) / at.length, apart: at.length > 1 ? Math.abs(at[0] - at[1]) : 0 };
  };
  chart.plot.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "touch" && !event.shiftKey) return;
    held.set(event.pointerId, event.clientX);
    before = now();
    if (event.pointerType !== "touch") chart.plot.setPointerCapture(event.pointerId);
  });
  chart.plot.addEventListener("pointermove", (event) => {
    if (!held.has(event.pointerId)) return;
    held.set(event.pointerId, event.clientX);
    const at = now();
    const box = chart.u.over.getBoundingClientRect();
    if (at.apart > 10 && before.apart > 10) {
      chart.zoom(before.apart / at.apart, chart.u.posToVal(at.middle - box.left, "x"));
    }
    chart.move((before.middle - at.middle) / box.width);
    before = at;
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
    chart.plot.addEventListener(name, (event) => {
      held.delete(event.pointerId);
      if (held.size) before = now();
    });
  }
}
