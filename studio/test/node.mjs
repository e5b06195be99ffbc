// Runs the simulator in Node, from the folder that `cargo xtask studio` builds, and natively, for comparison.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliDecompressSync } from "node:zlib";
import { load } from "./bundle.mjs";

export const root = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const target = process.env.CARGO_TARGET_DIR ?? join(root, "target");

/** The built page. */
export const built = process.env.DRIFTWORLD_PAGE ?? join(target, "studio");

/** The module that browsers unpack. */
export function simulator() {
  return brotliDecompressSync(readFileSync(join(built, "driftworld.wasm.br")));
}

let wasm = null;

/** A new simulator: a function that answers calls. */
export async function started() {
  if (!wasm) {
    const { start } = await load("wasm.ts");
    wasm = { start, module: await WebAssembly.compile(simulator()) };
  }
  return wasm.start(wasm.module);
}

export const network = (name) => new Uint8Array(readFileSync(join(root, "examples/networks", `${name}.safetensors`)));

/** The native answers to groups of calls; `cargo build -p driftworld-wasm --example answers` builds the program. */
export function native(groups) {
  const program = process.env.DRIFTWORLD_ANSWERS ?? join(target, "debug", "examples", "answers");
  const folder = mkdtempSync(join(tmpdir(), "driftworld-answers-"));
  try {
    const script = join(folder, "script.json");
    writeFileSync(script, JSON.stringify(groups));
    return JSON.parse(execFileSync(program, [script], { encoding: "utf8", maxBuffer: 1 << 26 }));
  } finally {
    rmSync(folder, { recursive: true });
  }
}
