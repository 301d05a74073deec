// The legend of a figure: a button per item, which switches it on and off and shows its value at
// the cursor.

/** The entries of a chart's items; null for an item without a name. */
function entriesOf(chart) {
  let others = null;
  return chart.spec.items.map((item, i) => {
    if (!item.label) return null;
    if (!item.role.startsWith("other")) return entryOf(chart, chart.legend, item, i);
    if (!others) {
      others = add(chart.legend, "span", "others");
      others.setAttribute("role", "group");
      others.setAttribute("aria-label", "Other laws of this place");
      add(others, "span", "group", "Other laws:");
    }
    return entryOf(chart, others, item, i);
  });
}

function entryOf(chart, parent, item, i) {
  const button = add(parent, "button", "entry");
  button.type = "button";
  button.setAttribute("aria-pressed", String(chart.on[i]));
  const mark = add(button, "canvas", "mark");
  [mark.width, mark.height] = [56, 24];
  mark.setAttribute("aria-hidden", "true");
  add(button, "bdi", "", item.label);
  const value = add(button, "output", "value");
  button.addEventListener("click", () => {
    chart.toggle(i, !chart.on[i]);
    chart.onToggle(item.label, chart.on[i]);
  });
  return { button, mark, value };
}

/** Draws how items look into their entries. */
function drawMarks(chart) {
  chart.spec.items.forEach((item, i) => {
    const entry = chart.entries[i];
    if (entry) drawSample(entry.mark.getContext("2d"), item, chart.colours[item.role]);
  });
}
