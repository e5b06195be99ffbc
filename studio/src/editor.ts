// The editor of documents: CodeMirror in a shadow root, so that its styles need no exception from the page's content security policy. Loaded on first use.

import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, isolateHistory, redo, undo } from "@codemirror/commands";
import { json } from "@codemirror/lang-json";
import { bracketMatching, foldGutter, foldKeymap, HighlightStyle, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { type Diagnostic, lintGutter, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Json, Problem, Task } from "./engine.ts";
import { type Change, cursorAt } from "./json_text.ts";
import { suggestions } from "./schema.ts";

/** The editor as the author view uses it. */
export interface Editor {
  text(): string;
  /** Replaces or changes the text; both can be undone. The changes of one `drag` are undone together. */
  replace(text: string): void;
  change(change: Change, kind?: "alone" | "drag"): void;
  /** Selects a part of the text and shows it. */
  show(from: number, to: number): void;
  /** Marks problems at their positions. */
  mark(problems: Problem[]): void;
  undo(): void;
  redo(): void;
  destroy(): void;
}

const THEME = EditorView.theme({
  "&": { height: "100%", fontSize: "13px", color: "var(--ink)", backgroundColor: "var(--card)" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.55" },
  ".cm-content": { caretColor: "var(--ink)", padding: "8px 0" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-gutters": { backgroundColor: "var(--card)", color: "var(--faint)", border: "none" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "var(--soft)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "var(--link-soft)" },
  ".cm-tooltip": { backgroundColor: "var(--card)", color: "var(--ink)", border: "1px solid var(--rim)", borderRadius: "8px", overflow: "hidden" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--link-soft)", color: "var(--ink)" },
  ".cm-completionDetail": { fontStyle: "normal", color: "var(--faint)", fontFamily: "system-ui, sans-serif" },
  ".cm-diagnostic": { fontFamily: "system-ui, sans-serif", padding: "6px 10px", maxWidth: "36rem" },
});

const COLORS = HighlightStyle.define([
  { tag: tags.propertyName, color: "var(--link)" },
  { tag: tags.string, color: "var(--good)" },
  { tag: [tags.number, tags.bool, tags.null], color: "var(--bad)" },
  { tag: [tags.separator, tags.squareBracket, tags.brace], color: "var(--faint)" },
]);

/** Puts an editor into an element. `context` returns the schema and the task for completion. */
export function createEditor(place: HTMLElement, text: string, context: () => { schema: Json; task: Task | null }, changed: (text: string) => void): Editor {
  const complete = (completion: CompletionContext): CompletionResult | null => {
    const cursor = cursorAt(completion.state.doc.toString(), completion.pos);
    if (!completion.explicit && cursor.from === completion.pos) return null;
    const { schema, task } = context();
    const options = suggestions(schema, cursor, task).map(({ insert, detail }) => ({
      label: insert, detail: detail.length > 70 ? `${detail.slice(0, 69)}…` : detail, apply: cursor.at === "key" ? `${insert}: ` : insert,
    }));
    return options.length ? { from: cursor.from, options } : null;
  };
  const root = place.shadowRoot ?? place.attachShadow({ mode: "open" });
  const view = new EditorView({
    root,
    parent: root,
    state: EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(), foldGutter(), lintGutter(), history(), drawSelection(), highlightActiveLine(), bracketMatching(), closeBrackets(),
        indentOnInput(), indentUnit.of("  "), json(), syntaxHighlighting(COLORS), THEME, EditorView.lineWrapping,
        autocompletion({ override: [complete], icons: false }),
        EditorView.contentAttributes.of({ "aria-label": "Text of the task", tabindex: "0" }),
        keymap.of([...closeBracketsKeymap, ...completionKeymap, ...defaultKeymap, ...historyKeymap, ...foldKeymap]),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) changed(update.state.doc.toString());
        }),
      ],
    }),
  });
  const offset = ({ line, column }: Problem): number => {
    const at = view.state.doc.line(Math.min(Math.max(1, line), view.state.doc.lines));
    // Columns count characters; a column beyond the line means its end.
    return at.from + Math.min([...at.text].slice(0, Math.max(0, column - 1)).join("").length, at.length);
  };
  return {
    text: () => view.state.doc.toString(),
    replace: (next) => view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: next }, selection: { anchor: 0 }, userEvent: "input.replace" }),
    change: (changes, kind = "alone") => view.dispatch({
      changes, userEvent: "input.control", annotations: kind === "alone" ? [isolateHistory.of("full")] : [],
    }),
    show: (from, to) => {
      const end = view.state.doc.length;
      const [anchor, head] = [Math.min(from, end), Math.min(to, end)];
      view.dispatch({ selection: { anchor, head }, effects: EditorView.scrollIntoView(anchor, { y: "center" }) });
      view.focus();
    },
    mark: (problems) => {
      const diagnostics = problems.map((problem): Diagnostic => {
        const from = offset(problem);
        const word = /^("(?:[^"\\]|\\.)*"|[^\s,\]}]+)/.exec(view.state.sliceDoc(from, from + 80))?.[0].length ?? 1;
        return { from, to: Math.min(from + word, view.state.doc.length), severity: "error", message: problem.message };
      });
      view.dispatch(setDiagnostics(view.state, diagnostics.sort((a, b) => a.from - b.from)));
    },
    undo: () => undo(view),
    redo: () => redo(view),
    destroy: () => view.destroy(),
  };
}
