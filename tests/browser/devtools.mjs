// Headless Chromium, driven through the DevTools protocol over a pair of pipes: no package, no
// port, no network.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const FLAGS = [
  "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-dev-shm-usage",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
  "--hide-scrollbars", "--remote-debugging-pipe",
];

/** A running browser. */
export class Browser {
  static async start() {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), "lacuna-browser-"));
    const program = process.env.CHROMIUM || "chromium";
    browser.process = spawn(program, [...FLAGS, `--user-data-dir=${browser.profile}`, "about:blank"], {
      stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"],
    });
    browser.waiting = new Map();
    browser.listeners = new Set();
    browser.number = 0;
    browser.gone = new Promise((resolve) => browser.process.on("exit", resolve));
    browser.process.on("error", (error) => browser.fail(error));
    browser.process.on("exit", () => browser.fail(new Error("the browser has ended")));
    let rest = Buffer.alloc(0);
    browser.process.stdio[4].on("data", (piece) => {
      rest = Buffer.concat([rest, piece]);
      for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1)) {
        browser.hear(JSON.parse(rest.subarray(0, end).toString()));
      }
    });
    return browser;
  }

  hear(message) {
    const asked = this.waiting.get(message.id);
    if (!asked) return this.listeners.forEach((listener) => listener(message));
    this.waiting.delete(message.id);
    if (message.error) asked.reject(new Error(`${asked.method}: ${message.error.message}`));
    else asked.resolve(message.result);
  }

  fail(error) {
    this.waiting.forEach((asked) => asked.reject(error));
    this.waiting.clear();
  }

  /** Calls a method of the protocol. */
  call(method, params = {}, sessionId = undefined) {
    const id = ++this.number;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject, method }));
  }

  /** Opens a file in a tab of its own and waits until it is loaded. */
  async open(path, { width = 1400, height = 900, dark = false, touch = false, scripts = true } = {}) {
    const { targetId } = await this.call("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.call("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    await page.call("Page.enable");
    await page.call("Runtime.enable");
    await page.call("Log.enable");
    await page.call("Network.enable");
    await page.call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: touch });
    if (touch) await page.call("Emulation.setTouchEmulationEnabled", { enabled: true });
    if (!scripts) await page.call("Emulation.setScriptExecutionDisabled", { value: true });
    const features = [{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }];
    await page.call("Emulation.setEmulatedMedia", { features });
    const loaded = page.heard("Page.loadEventFired");
    await page.call("Page.navigate", { url: pathToFileURL(path).href });
    await loaded;
    return page;
  }

  async stop() {
    await this.call("Browser.close").catch(() => {});
    await this.gone;
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 });
  }
}

/** A tab, with everything it complained of and asked the network for. */
export class Page {
  constructor(browser, session, target) {
    Object.assign(this, { browser, session, target, complaints: [], requests: [] });
    browser.listeners.add((message) => message.sessionId === session && this.hear(message));
    this.hopes = [];
  }

  hear({ method, params }) {
    if (method === "Runtime.exceptionThrown") {
      const details = params.exceptionDetails;
      this.complaints.push(details.exception?.description ?? details.text);
    }
    if (method === "Runtime.consoleAPICalled" && ["error", "warning", "assert"].includes(params.type)) {
      this.complaints.push(params.args.map((a) => a.value ?? a.description).join(" "));
    }
    if (method === "Log.entryAdded" && ["error", "warning"].includes(params.entry.level)) {
      this.complaints.push(params.entry.text);
    }
    if (method === "Network.requestWillBeSent") this.requests.push(params.request.url);
    this.hopes = this.hopes.filter((hope) => hope.method !== method || hope.resolve(params));
  }

  /** The next event of a name. */
  heard(method) {
    return new Promise((resolve) => this.hopes.push({ method, resolve }));
  }

  call(method, params) {
    return this.browser.call(method, params, this.session);
  }

  /** The value of an expression, or of a function with arguments, in the page. */
  async ask(what, ...args) {
    const expression = typeof what === "function" ? `(${what})(${args.map((a) => JSON.stringify(a)).join(",")})` : what;
    const { result, exceptionDetails } = await this.call("Runtime.evaluate", {
      expression, returnByValue: true, awaitPromise: true,
    });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  mouse(type, x, y, more = {}) {
    return this.call("Input.dispatchMouseEvent", { type, x, y, button: "none", ...more });
  }

  /** Drags from one point to another; modifiers: 1 alt, 2 ctrl, 4 meta, 8 shift. */
  async drag([x0, y0], [x1, y1], modifiers = 0) {
    await this.mouse("mouseMoved", x0, y0, { modifiers });
    await this.mouse("mousePressed", x0, y0, { button: "left", clickCount: 1, buttons: 1, modifiers });
    for (const share of [0.3, 0.6, 1]) {
      await this.mouse("mouseMoved", x0 + share * (x1 - x0), y0 + share * (y1 - y0), { button: "left", buttons: 1, modifiers });
    }
    await this.mouse("mouseReleased", x1, y1, { button: "left", clickCount: 1, modifiers });
  }

  async key(key, modifiers = 0) {
    // what presses a button is told by its code
    const more = key === " " ? { code: "Space", windowsVirtualKeyCode: 32 } : {};
    const text = key === " " ? { text: " " } : {};
    await this.call("Input.dispatchKeyEvent", { type: "keyDown", key, modifiers, ...more, ...text });
    await this.call("Input.dispatchKeyEvent", { type: "keyUp", key, modifiers, ...more });
  }

  async picture(whole = true) {
    const { data } = await this.call("Page.captureScreenshot", { format: "png", captureBeyondViewport: whole });
    return Buffer.from(data, "base64");
  }

  async print() {
    const { data } = await this.call("Page.printToPDF", { printBackground: false });
    return Buffer.from(data, "base64");
  }

  close() {
    return this.browser.call("Target.closeTarget", { targetId: this.target });
  }
}
