// A page as a person sees it: pictures at 1400 and 400 px, light, dark and in print, and how long it takes
// to be there.
//
//   node look.mjs REPORT FOLDER       writes PNG pictures and print.pdf into FOLDER, prints the times
//
// Times count from the start of the navigation: `paint` is the first that is seen (First Contentful
// Paint, W3C Paint Timing), `figures` when every figure is drawn; medians of five loads.

import { mkdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { Browser } from "./devtools.mjs";

const [report, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const LOADS = 5;
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

const times = () => new Promise((done) => {
  const ask = () => {
    const paint = performance.getEntriesByName("first-contentful-paint")[0];
    if (!paint) return requestAnimationFrame(ask);
    done({ paint: paint.startTime, figures: Number(document.documentElement.dataset.ready) });
  };
  ask();
});

const browser = await Browser.start();
try {
  for (const width of [1400, 400]) {
    const options = { width, height: width === 400 ? 800 : 900, touch: width === 400 };
    const all = [];
    for (let k = 0; k < LOADS; k++) {
      const page = await browser.open(report, options);
      all.push(await page.ask(times));
      await page.close();
    }
    const of = (what) => median(all.map((one) => one[what])).toFixed(0);
    console.log(`${width} px: paint ${of("paint")} ms, figures ${of("figures")} ms, ${statSync(report).size} bytes`);
    for (const dark of [false, true]) {
      const page = await browser.open(report, { ...options, dark });
      writeFileSync(join(folder, `${width}-${dark ? "dark" : "light"}.png`), await page.picture());
      if (page.complaints.length) console.log(page.complaints);
      await page.close();
    }
  }
  const page = await browser.open(report);
  writeFileSync(join(folder, "print.pdf"), await page.print());
} finally {
  await browser.stop();
}
