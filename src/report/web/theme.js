// How roles look: colours from the page's style sheet, dash patterns and markers of their own, so
// that no two things in a figure differ by colour alone.

/** Width, dash pattern, opacity and size of the marker of every role. */
const LOOKS = {
  measured: { width: 3.4, dash: [], alpha: 0.5, marker: 2.2 },
  before: { width: 1.5, dash: [7, 4], alpha: 1, marker: 0 },
  after: { width: 1.8, dash: [], alpha: 1, marker: 0 },
  law: { width: 2.4, dash: [], alpha: 1, marker: 0 },
  free: { width: 1.3, dash: [], alpha: 1, marker: 0 },
  floor: { width: 1.6, dash: [2, 4], alpha: 1, marker: 0 },
  quiet: { width: 1.2, dash: [4, 4], alpha: 1, marker: 0 },
  other1: { width: 2, dash: [9, 4], alpha: 1, marker: 0 },
  other2: { width: 2, dash: [3, 3], alpha: 1, marker: 0 },
  other3: { width: 2, dash: [10, 3, 2, 3], alpha: 1, marker: 0 },
  other4: { width: 2, dash: [14, 3, 3, 3, 3, 3], alpha: 1, marker: 0 },
};

/** Colours of the page as they are now: by role, and `ink`, `soft`, `rule`, `card`. */
function palette(element) {
  const style = getComputedStyle(element);
  const colours = {};
  for (const name of [...Object.keys(LOOKS), "ink", "soft", "rule", "card"]) {
    colours[name] = style.getPropertyValue(`--${name}`).trim() || "#888";
  }
  return colours;
}

/** A number for an axis: as few digits as tell neighbours `step` apart. */
function tick(v, step) {
  const size = Math.abs(v);
  if (size !== 0 && (size >= 1e5 || size < 1e-3) && Math.abs(step) < 1e-3 * 1.0001 + size) {
    const places = Math.max(0, Math.min(3, Math.floor(Math.log10(size)) - Math.floor(Math.log10(step))));
    return v.toExponential(places).replace("e+", "e").replaceAll("-", "\u2212");
  }
  // steps such as 0.25 need a digit more than their power of ten
  let places = Math.max(0, Math.min(9, -Math.floor(Math.log10(step) + 1e-9)));
  if (places < 9 && Math.abs(step - Number(step.toFixed(places))) > 1e-3 * step) places++;
  const text = v.toFixed(places);
  return (Number(text) === 0 ? "0" : text).replaceAll("-", "\u2212");
}

/** A value for people: five significant digits. */
function shown(v) {
  if (!Number.isFinite(v)) return "\u2013";
  const size = Math.abs(v);
  const text = size !== 0 && (size >= 1e6 || size < 1e-4) ? v.toExponential(4) : String(Number(v.toPrecision(5)));
  return text.replaceAll("-", "\u2212");
}
