// Bundles the page and packs the simulator: `node build.mjs WASM OUT`, as `cargo xtask studio` calls it. Prints the size of each file.

import { build } from "esbuild";
import { cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import { load } from "./test/bundle.mjs";

/** Maximum number of bytes that a browser transfers to show the page and run the simulator, excluding networks. */
const MAX_BYTES = 2_500_000;

const here = dirname(fileURLToPath(import.meta.url));
const [wasm, out] = process.argv.slice(2);
if (!wasm || !out) {
  console.error("build.mjs: found too few arguments, expected: node build.mjs WASM OUT; run `cargo xtask studio`");
  process.exit(2);
}

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
await build({
  absWorkingDir: here,
  entryPoints: { main: "src/main.tsx", worker: "src/worker.ts", style: "src/style.css" },
  outdir: out,
  bundle: true,
  loader: { ".json": "text" },
  // The editor is a separate file, loaded only when a text is edited.
  splitting: true,
  format: "esm",
  target: "es2022",
  minify: true,
  legalComments: "none",
  logLevel: "warning",
});
for (const name of ["index.html", "icon.svg"]) cpSync(join(here, name), join(out, name));

const compress = (bytes, name) => brotliCompressSync(bytes, {
  params: {
    [constants.BROTLI_PARAM_QUALITY]: 11,
    [constants.BROTLI_PARAM_LGWIN]: 24,
    [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
    [constants.BROTLI_PARAM_MODE]: name.endsWith(".wasm") ? constants.BROTLI_MODE_GENERIC : constants.BROTLI_MODE_TEXT,
  },
});

// The contents of the gallery are computed at build time: the simulator takes a second to read all tasks.
const simulator = readFileSync(wasm);
const { start } = await load("wasm.ts");
const ask = await start(await WebAssembly.compile(simulator));
writeFileSync(join(out, "tasks.json"), JSON.stringify(JSON.parse(ask({ call: "tasks" }).json).ok));

let sum = 0;
const report = (name, raw, compressed) => console.log(`${name.padEnd(20)} ${String(raw).padStart(9)} bytes, ${String(compressed).padStart(9)} by brotli`);
for (const name of readdirSync(out).sort()) {
  const bytes = readFileSync(join(out, name));
  const size = compress(bytes, name).length;
  sum += size;
  report(name, bytes.length, size);
}
const compressed = compress(simulator, "driftworld.wasm");
writeFileSync(join(out, "driftworld.wasm.br"), compressed);
// For browsers that cannot decompress brotli.
writeFileSync(join(out, "driftworld.wasm.gz"), gzipSync(simulator, { level: 9 }));
sum += compressed.length;
report("driftworld.wasm", simulator.length, compressed.length);

// Trained networks, fetched when needed.
const networks = join(here, "..", "examples", "networks");
mkdirSync(join(out, "networks"));
const names = readdirSync(networks).filter((name) => name.endsWith(".safetensors")).sort();
for (const name of names) cpSync(join(networks, name), join(out, "networks", name));
writeFileSync(join(out, "networks", "index.json"), JSON.stringify(names.map((name) => basename(name, ".safetensors"))));

console.log(`in all               ${sum} bytes by brotli, at most ${MAX_BYTES}; separate networks: ${names.join(", ")}`);
if (sum > MAX_BYTES) {
  console.error(`build.mjs: found ${sum} bytes by brotli, expected at most ${MAX_BYTES}; make the page or the simulator smaller`);
  process.exit(1);
}
