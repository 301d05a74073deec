// Puts the figures of a page to work.

/** Charts that are linked, group by group; a chart without a link is a group of its own. */
function groupsOf(charts) {
  const groups = new Map();
  charts.forEach((chart, i) => {
    const key = chart.spec.link ?? `alone ${i}`;
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(chart);
  });
  return [...groups.values()];
}

/** Remembers ranges and switches while a page that follows running work loads itself again. */
const memory = {
  key: () => `lacuna ${location.pathname}`,
  keep(charts) {
    const states = charts.map((chart) => ({ view: chart.touched ? chart.view : null, on: chart.on }));
    try {
      sessionStorage.setItem(this.key(), JSON.stringify({ states, scroll: scrollY }));
    } catch {
      // a browser that keeps nothing shows the page as it was first drawn
    }
  },
  recall(charts) {
    let kept = null;
    try {
      kept = JSON.parse(sessionStorage.getItem(this.key()));
      sessionStorage.removeItem(this.key());
    } catch {
      return;
    }
    if (kept?.states?.length !== charts.length) return;
    charts.forEach((chart, i) => {
      const { view, on } = kept.states[i];
      if (on.length === chart.on.length) on.forEach((value, k) => value !== chart.on[k] && chart.toggle(k, value));
      if (view) chart.show(view);
    });
    scrollTo(0, kept.scroll);
  },
};

function start() {
  document.documentElement.classList.add("scripted");
  const specs = unpack(JSON.parse(document.getElementById("figures").textContent));
  const begins = (spec) => spec.view ?? specs.find((other) => spec.link && other.link === spec.link && other.view)?.view;
  const charts = [...document.querySelectorAll("figure[data-figure]")].map((figure) => {
    const spec = specs[Number(figure.dataset.figure)];
    return new Chart(figure, spec, begins(spec));
  });
  const groups = groupsOf(charts);
  groups.filter((group) => group[0].spec.link).forEach(link);
  const redraw = () => {
    charts.forEach((chart) => chart.draw());
    groups.forEach((group) => group.strip?.draw());
  };
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === width) return;
    width = innerWidth;
    redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  // paper is white, shows what is folded, and shows figures as they were left
  addEventListener("beforeprint", () => {
    document.documentElement.classList.add("printed");
    document.querySelectorAll("details").forEach((part) => (part.open = true));
    charts.forEach((chart) => chart.figure.classList.toggle("touched", chart.touched));
    redraw();
  });
  addEventListener("afterprint", () => {
    document.documentElement.classList.remove("printed");
    redraw();
  });
  const seconds = Number(document.documentElement.dataset.again);
  if (seconds > 0) {
    memory.recall(charts);
    setTimeout(() => {
      memory.keep(charts);
      location.reload();
    }, 1000 * seconds);
  }
  document.documentElement.dataset.ready = performance.now().toFixed(0);
}

start();
