// The simulator as a WebAssembly instance. Calls and answers are JSON with optional bytes.

interface Exports {
  memory: WebAssembly.Memory;
  driftworld_memory(length: number): number;
  driftworld_call(input: number, length: number, json: number): number;
}

/** A JSON answer with a copy of its bytes. */
export interface Answer {
  json: string;
  bytes: Uint8Array<ArrayBuffer>;
}

/** Sends a call to the simulator. */
export type Caller = (call: unknown, bytes?: Uint8Array) => Answer;

/** Starts the simulator. The module has no imports: it reads no clock, no files and no network. */
export async function start(module: WebAssembly.Module): Promise<Caller> {
  const instance = await WebAssembly.instantiate(module, {});
  const { memory, driftworld_memory, driftworld_call } = instance.exports as unknown as Exports;
  const encoder = new TextEncoder();
  const decoder = new TextDecoder();
  return (call, bytes = new Uint8Array()) => {
    const json = encoder.encode(JSON.stringify(call));
    const length = json.length + bytes.length;
    const input = driftworld_memory(length);
    const target = new Uint8Array(memory.buffer, input, length);
    target.set(json);
    target.set(bytes, json.length);
    const answer = driftworld_call(input, length, json.length);
    const [textAt, textLength, bytesAt, bytesLength] = new Uint32Array(memory.buffer, answer, 4) as unknown as [number, number, number, number];
    return {
      json: decoder.decode(new Uint8Array(memory.buffer, textAt, textLength)),
      bytes: new Uint8Array(memory.buffer.slice(bytesAt, bytesAt + bytesLength)),
    };
  };
}

/** Loads the module from the page's folder: the brotli file if the browser can decompress it, else the gzip file. The server needs no configuration. */
export async function load(base: string): Promise<WebAssembly.Module> {
  const [name, decompressor] = pickCompression();
  const reply = await fetch(new URL(name, base));
  if (!reply.ok || !reply.body) {
    throw new Error(`${name}: found ${reply.status}, expected the simulator; build the page with \`cargo xtask studio\``);
  }
  const stream = reply.body.pipeThrough(decompressor);
  return WebAssembly.compileStreaming(new Response(stream, { headers: { "content-type": "application/wasm" } }));
}

function pickCompression(): [string, ReadableWritablePair<Uint8Array<ArrayBuffer>, BufferSource>] {
  try {
    // TypeScript does not know this format yet; browsers without it throw.
    return ["driftworld.wasm.br", new DecompressionStream("brotli" as CompressionFormat)];
  } catch {
    return ["driftworld.wasm.gz", new DecompressionStream("gzip")];
  }
}
