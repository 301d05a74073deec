// The page in a real browser: it opens, zooms, reads, switches, saves, prints, on paper and on a
// telephone, asks for nothing and complains of nothing; names that carry markup are shown.
//
//   node --test page.test.mjs        with PAGES naming a folder of pages, made by `run`

import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { Browser } from "./devtools.mjs";

const folder = process.env.PAGES;
assert.ok(folder, "PAGES names no folder");
const path = (name) => join(folder, name, "report.html");

let browser;
before(async () => (browser = await Browser.start()));
after(() => browser?.stop());

/** Opens a page and asks for nothing but the file itself. */
async function open(name, options) {
  const page = await browser.open(path(name), options);
  assert.deepEqual(page.complaints, [], name);
  assert.deepEqual(page.requests.filter((url) => !url.startsWith("file:")), []);
  assert.equal(page.requests.length, 1, `${name} asked for ${page.requests}`);
  return page;
}

/** All figures: title, whether drawn, range, pixels of the plot that are not its ground. */
const figures = () => [...document.querySelectorAll("figure[data-figure]")].map((figure) => {
  const canvas = figure.querySelector(".plot canvas");
  // read from a copy: a canvas that is read often is made slow by the browser, which says so
  const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
  const ctx = copy.getContext("2d", { willReadFrequently: true });
  ctx.drawImage(canvas, 0, 0);
  const { data } = ctx.getImageData(0, 0, canvas.width, canvas.height);
  let inked = 0;
  for (let i = 3; i < data.length; i += 4) if (data[i] > 60) inked++;
  const box = figure.getBoundingClientRect();
  return {
    title: figure.querySelector("figcaption").textContent,
    drawn: figure.dataset.drawn,
    view: figure.dataset.view?.split(" ").map(Number),
    inked,
    right: box.right,
    over: (({ left, top, width, height }) => ({ left, top, width, height }))(
      figure.querySelector(".u-over").getBoundingClientRect()),
  };
});

const named = (list, words) => list.find((figure) => figure.title.includes(words));

test("every figure of every page has data", async () => {
  for (const name of ["demo", "again", "long", "hostile"]) {
    const page = await open(name);
    const all = await page.ask(figures);
    assert.ok(all.length > 1, name);
    for (const figure of all) {
      assert.equal(figure.drawn, "yes", `${name}: ${figure.title}`);
      assert.ok(figure.inked > 300, `${name}: ${figure.title} has ${figure.inked} pixels`);
      assert.ok(figure.view.every(Number.isFinite) && figure.view[0] < figure.view[1]);
    }
    await page.close();
  }
});

test("a range that is marked is shown by all linked figures, and by no other", async () => {
  const page = await open("demo");
  const before = await page.ask(figures);
  const signal = named(before, "y over time");
  await page.ask(() => document.querySelector("figure .strip").scrollIntoView({ block: "start" }));
  const { over } = named(await page.ask(figures), "y over time");
  const y = over.top + over.height / 2;
  await page.drag([over.left + 0.25 * over.width, y], [over.left + 0.5 * over.width, y]);
  const zoomed = await page.ask(figures);
  const [low, high] = named(zoomed, "y over time").view;
  const width = signal.view[1] - signal.view[0];
  assert.ok(Math.abs(low - (signal.view[0] + 0.25 * width)) < 0.02 * width, `${low}`);
  assert.ok(Math.abs(high - low - 0.25 * width) < 0.02 * width, `${high}`);
  for (const words of ["Residual of y: ", "Input u"]) {
    assert.deepEqual(named(zoomed, words).view, [low, high], words);
  }
  assert.deepEqual(named(zoomed, "Spectrum").view, named(before, "Spectrum").view);
  // with shift the same hand moves the range
  await page.drag([over.left + 0.5 * over.width, y], [over.left + 0.25 * over.width, y], 8);
  const moved = named(await page.ask(figures), "y over time").view;
  assert.ok(Math.abs(moved[0] - low - 0.25 * (high - low)) < 0.02 * width, `${moved}`);
  // the wheel with ctrl zooms about the pointer, without it the page scrolls
  await page.mouse("mouseWheel", over.left + 10, y, { deltaX: 0, deltaY: -200, modifiers: 2 });
  const wheeled = named(await page.ask(figures), "y over time").view;
  assert.ok(wheeled[1] - wheeled[0] < 0.9 * (moved[1] - moved[0]), `${wheeled}`);
  // a double click shows all
  for (const clickCount of [1, 2]) {
    await page.mouse("mousePressed", over.left + 50, y, { button: "left", clickCount });
    await page.mouse("mouseReleased", over.left + 50, y, { button: "left", clickCount });
  }
  const whole = named(await page.ask(figures), "y over time").view;
  assert.ok(whole[0] === 0 && whole[1] > 2 * width, `${whole}`);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("values stand under the cursor, for the mouse, the keys and the ear", async () => {
  const page = await open("demo");
  await page.ask(() => document.querySelector("figure .strip").scrollIntoView({ block: "start" }));
  const { over } = named(await page.ask(figures), "y over time");
  await page.mouse("mouseMoved", over.left + over.width / 2, over.top + 20);
  const values = () => [...document.querySelector("figure:has(.strip)").querySelectorAll(".value")].map((v) => v.textContent);
  const read = await page.ask(values);
  assert.equal(read.length, 3);
  assert.ok(read.every((text) => /^\u2212?[0-9.]+/.test(text)), `${read}`);
  await page.ask(() => document.querySelector("figure:has(.strip) .plot").focus());
  await page.key("ArrowRight");
  const said = await page.ask(() => document.querySelector("figure:has(.strip) [aria-live]").textContent);
  assert.match(said, /time \[s\] [0-9.]+: measured .+, model .+, extended model /);
  const before = named(await page.ask(figures), "y over time").view;
  await page.key("+");
  const after = named(await page.ask(figures), "y over time").view;
  assert.ok(Math.abs((after[1] - after[0]) / (before[1] - before[0]) - 0.5) < 1e-6);
  await page.key("0");
  assert.equal(named(await page.ask(figures), "y over time").view[0], 0);
  await page.close();
});

test("a line is switched off wherever it is shown", async () => {
  const page = await open("demo");
  const ink = async () => {
    const all = await page.ask(figures);
    return ["y over time", "Residual of y: "].map((words) => named(all, words).inked);
  };
  const before = await ink();
  const press = () => page.ask(() => {
    const entries = [...document.querySelectorAll("figure:has(.strip) .entry")];
    const entry = entries.find((e) => e.textContent.startsWith("model"));
    entry.click();
    return entry.getAttribute("aria-pressed");
  });
  assert.equal(await press(), "false");
  const off = await ink();
  assert.ok(off.every((pixels, i) => pixels !== before[i]), `${before} ${off}`);
  assert.equal(await press(), "true");
  assert.deepEqual(await ink(), before);
  await page.close();
});

test("other laws of a place are drawn when they are asked for, by keys", async () => {
  for (const name of ["demo", "again", "long"]) {
    const page = await open(name);
    const law = async () => (await page.ask(figures)).find((figure) => figure.title.includes("missing in") || figure.title.includes("lacks in"));
    const before = await law();
    const focused = await page.ask(() => {
      const entry = document.querySelector(".others .entry");
      entry.focus();
      return { group: entry.parentElement.getAttribute("aria-label"), text: entry.textContent, pressed: entry.getAttribute("aria-pressed") };
    });
    assert.equal(focused.group, "Other laws of this place");
    assert.match(focused.text, /^[a-z_ +]+ \([^)]*%\)/);
    assert.equal(focused.pressed, "false", "another law is drawn at first");
    await page.key(" ");
    assert.equal(await page.ask("document.activeElement.getAttribute('aria-pressed')"), "true");
    assert.notEqual((await law()).inked, before.inked, `${name}: nothing was drawn`);
    await page.key(" ");
    assert.equal((await law()).inked, before.inked);
    await page.close();
  }
});

test("an axis shows the range that was asked for, and no whole decades", async () => {
  for (const name of ["demo", "long"]) {
    const page = await open(name);
    const all = await page.ask(() => [...document.querySelectorAll("figure[data-figure]")].map((f) => [f.dataset.view, f.dataset.range]));
    for (const [view, drawn] of all) assert.equal(drawn, view, name);
    await page.close();
  }
});

test("no two items of a figure look the same", async () => {
  const page = await open("demo");
  const looks = await page.ask(() => JSON.parse(document.getElementById("figures").textContent).charts.map((chart) =>
    chart.items.filter((item) => item.label && item.kind === "line").map((item) => {
      const { width, dash } = LOOKS[item.role];
      return `${width} ${dash}`;
    })));
  for (const list of looks) assert.equal(new Set(list).size, list.length, `${list}`);
  await page.close();
});

test("the data of a figure are saved", async () => {
  const page = await open("demo");
  const text = await page.ask(async () => {
    let saved = null;
    URL.createObjectURL = (blob) => ((saved = blob), "blob:none");
    HTMLAnchorElement.prototype.click = function () { this.dataset.name = this.download; };
    const button = [...document.querySelectorAll("figure:has(.strip) button")].find((b) => b.textContent === "Save CSV");
    button.click();
    return saved.text();
  });
  const lines = text.trim().split("\n");
  assert.equal(lines[0], "time [s],measured,model,extended model");
  assert.ok(lines.length > 1000);
  assert.ok(lines.slice(1).every((line) => line.split(",").length === 4));
  await page.close();
});

test("a record of 100 000 samples is there at once and follows the hand", async (t) => {
  const size = statSync(path("long")).size;
  assert.ok(size < 2e6, `${size} bytes`);
  const page = await open("long");
  const ready = Number(await page.ask("document.documentElement.dataset.ready"));
  const frames = await page.ask(() => {
    const plot = document.querySelector("figure:has(.strip) .plot");
    const press = (key) => plot.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey: key !== "0" }));
    const started = performance.now();
    press("0");
    const whole = performance.now() - started;
    for (let i = 0; i < 20; i++) press(i % 2 ? "ArrowLeft" : "ArrowRight");
    return { whole, each: (performance.now() - started - whole) / 20 };
  });
  t.diagnostic(`${size} bytes, drawn after ${ready} ms; all linked figures: whole ${frames.whole.toFixed(1)} ms, moved ${frames.each.toFixed(1)} ms`);
  // generous, because a test machine may be busy: a second is what is promised on a free one
  assert.ok(ready < 5000, `${ready} ms`);
  await page.close();
});

test("a telephone shows whole figures and no page wider than itself", async () => {
  for (const dark of [false, true]) {
    const page = await open("demo", { width: 400, height: 800, touch: true, dark });
    for (const figure of await page.ask(figures)) {
      assert.ok(figure.right <= 400, `${figure.title} ends at ${figure.right}`);
      assert.ok(figure.over.width > 250, `${figure.title} is ${figure.over.width} wide`);
    }
    assert.equal(await page.ask("document.documentElement.scrollWidth"), 400);
    const ground = await page.ask("getComputedStyle(document.body).backgroundColor");
    const light = Number(ground.match(/\d+/)[0]) > 128;
    assert.equal(light, !dark, ground);
    await page.close();
  }
});

test("it prints, and without scripts it shows everything that does not move", async () => {
  const page = await open("demo", { dark: true });
  const pdf = await page.print();
  assert.equal(pdf.subarray(0, 5).toString(), "%PDF-");
  assert.ok(pdf.length > 20000, `${pdf.length} bytes`);
  // still pictures are printed, but of a figure that was zoomed what it shows
  const printed = await page.ask(() => {
    document.querySelector("figure:has(.strip) .plot").dispatchEvent(new KeyboardEvent("keydown", { key: "+" }));
    dispatchEvent(new Event("beforeprint"));
    const touched = [...document.querySelectorAll(".touched figcaption")].map((caption) => caption.textContent);
    const ink = getComputedStyle(document.documentElement).getPropertyValue("--card");
    dispatchEvent(new Event("afterprint"));
    return { touched, ink };
  });
  assert.deepEqual(printed.touched, ["y over time", "Residual of y: measured minus simulated", "Input u"]);
  assert.equal(printed.ink, "#fff");
  await page.close();
  const bare = await browser.open(path("demo"), { scripts: false });
  const text = readFileSync(path("demo"), "utf8");
  assert.ok((text.match(/class="still"><svg/g) ?? []).length >= 5);
  assert.deepEqual(bare.complaints, []);
  await bare.close();
});

test("names that carry markup are shown and not obeyed", async () => {
  const page = await open("hostile");
  const seen = await page.ask(() => ({
    ran: globalThis.pwned === undefined,
    text: document.body.innerText,
    elements: document.querySelectorAll("main script, main img, main b, main i").length,
    scripts: document.scripts.length,
  }));
  assert.ok(seen.ran, "a name ran");
  assert.equal(seen.elements, 0);
  assert.equal(seen.scripts, 2);
  assert.ok(seen.text.includes("<script>") && seen.text.includes("[U+202E]"), "a name is not shown");
  assert.ok(!seen.text.includes("\u202e"));
  // even a script that got in would not run
  const blocked = await page.ask(() => {
    const script = document.createElement("script");
    script.textContent = "globalThis.pwned = true";
    document.body.append(script);
    return globalThis.pwned === undefined;
  });
  assert.ok(blocked, "the policy lets a script in");
  await page.close();
});

test("a page of running work loads itself again where it was left", async () => {
  const page = await open("running");
  assert.match(await page.ask("document.querySelector('.running').textContent"), /Running/);
  const zoomed = await page.ask(() => {
    document.querySelector("figure .plot").dispatchEvent(new KeyboardEvent("keydown", { key: "+" }));
    return document.querySelector("figure").dataset.view;
  });
  await page.heard("Page.loadEventFired");
  assert.equal(await page.ask("document.querySelector('figure').dataset.view"), zoomed);
  assert.deepEqual(page.complaints, []);
  await page.close();
});
