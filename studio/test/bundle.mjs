// Loads a TypeScript module into Node, bundled as in the page's build.

import { fileURLToPath } from "node:url";
import { build } from "esbuild";

/** The exports of `src/NAME`. */
export async function load(name) {
  const entry = fileURLToPath(new URL(`../src/${name}`, import.meta.url));
  const { outputFiles } = await build({ entryPoints: [entry], bundle: true, write: false, format: "esm", platform: "neutral", loader: { ".json": "text" }, jsx: "automatic", jsxImportSource: "preact", mainFields: ["module", "main"] });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}
