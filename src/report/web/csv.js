// The data of a figure as CSV.

/** A number with the digits that a stored column has. */
function digits(v) {
  return Number.isFinite(v) ? String(Number(v.toPrecision(8))) : "";
}

/**
 * A cell: quoted where it has to be, and never read as a formula by a spreadsheet, which takes
 * a text that begins with = + - or @ for one.
 */
function cell(text) {
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/** The name of an item's values: its label, or what the axis says. */
function nameOf(chart, item) {
  return item.label || chart.y.label;
}

/**
 * All data of a chart as CSV: one row per x where all items share their x, otherwise one row
 * per point, with the item's name in front.
 */
function csvOf(chart) {
  const items = chart.items.filter((item) => item.x);
  const lines = [];
  const shared = items.length > 0 && items.every((i) => i.key === items[0].key && i.kind === "line");
  if (shared) {
    const x = items[0].x;
    lines.push([chart.x.label, ...items.map((i) => nameOf(chart, i))].map(cell).join(","));
    for (let k = 0; k < x.n; k++) {
      lines.push([x.at(k), ...items.map((i) => i.y[k])].map(digits).join(","));
    }
  } else {
    lines.push(["item", chart.x.label, chart.y.label, "half bar or upper bound"].map(cell).join(","));
    for (const item of items) {
      const name = cell(nameOf(chart, item));
      for (let k = 0; k < item.x.n; k++) {
        const z = item.z ? digits(item.z[k]) : "";
        lines.push(`${name},${digits(item.x.at(k))},${digits(item.y[k])},${z}`);
      }
    }
  }
  for (const item of chart.items.filter((i) => i.kind === "level" && !shared)) {
    lines.push(`${cell(nameOf(chart, item))},,${digits(item.at)},`);
  }
  return lines.join("\n") + "\n";
}

/** A file name made of a title: letters, digits and hyphens. */
function fileName(title) {
  const name = title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-+|-+$/g, "");
  return `${name.slice(0, 60) || "figure"}.csv`;
}

/** Offers a text to be saved as a file. */
function save(name, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
