// The page's scripts, which are plain scripts without modules, for tests of their functions.

import { readFileSync } from "node:fs";

const folder = new URL("../../src/report/web/", import.meta.url);

/** Runs scripts together and gives what they declare under these names. */
export function load(files, names) {
  const text = files.map((file) => readFileSync(new URL(file, folder), "utf8")).join("\n");
  return new Function(`"use strict";\n${text}\nreturn { ${names.join(", ")} };`)();
}
