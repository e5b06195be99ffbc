// Messages on the page: errors, and texts to copy.

import { useState } from "preact/hooks";
import type { ComponentChildren } from "preact";
import type { EngineError } from "../engine.ts";
import type { Recipe } from "../commands.ts";

/** Explains an error and how to resolve it; `again` is offered if a retry may help. */
export function ErrorNote({ error, again, children }: { error: EngineError; again?: () => void; children?: ComponentChildren }) {
  const isStopped = error.code === "engine/stopped" || error.code === "engine/lost";
  const canRetry = /^(engine|page)\//.test(error.code);
  return (
    <div class={`note ${isStopped ? "warn" : "bad"}`} role="alert">
      <span>{isStopped ? "Stopped. The simulator restarts with the next action." : error.message}</span>
      {again && canRetry && <button type="button" onClick={again}>{isStopped ? "Start again" : "Try again"}</button>}
      {!isStopped && children}
    </div>
  );
}

/** Copies a text to the clipboard; returns false if the browser does not allow it. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false;
  }
}

/** Saves a text as a file. */
export function saveText(name: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** A button that copies a text and confirms it. */
export function CopyButton({ text, label, children }: { text: string; label: string; children?: ComponentChildren }) {
  const [status, setStatus] = useState("");
  const copy = async () => {
    setStatus((await copyText(text)) ? "Copied" : "Not allowed");
    setTimeout(() => setStatus(""), 1500);
  };
  return (
    <button type="button" aria-label={label} onClick={() => void copy()}>
      <span aria-live="polite">{status || (children ?? "Copy")}</span>
    </button>
  );
}

/** Shows recipes as shell commands and as Python, ready to copy. */
export function Recipes({ of }: { of: Record<string, Recipe> }) {
  return (
    <details class="copy">
      <summary>Copy as command or Python</summary>
      <div class="copies">
        {Object.entries(of).map(([what, recipe]) => (
          <section key={what} class="stack" aria-label={what}>
            <h3>{what}</h3>
            {(["command", "python"] as const).map((form) => (
              <div key={form}>
                <pre data-form={form} tabIndex={0}>{recipe[form].trimEnd()}</pre>
                <CopyButton text={recipe[form]} label={`Copy ${what.toLowerCase()} as ${form === "python" ? "Python" : "command"}`} />
              </div>
            ))}
          </section>
        ))}
      </div>
    </details>
  );
}
