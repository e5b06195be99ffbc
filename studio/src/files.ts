// Reads files that were dropped onto the page or picked. A folder yields all its files, with their paths.

import { EngineError, type DroppedFile } from "./engine.ts";

/** Maximum total size of the files; a log of a lifetime has a few megabytes. */
const MAX_BYTES = 256 * 1024 * 1024;
const MAX_FILES = 20_000;

async function readAll(files: { path: string; file: File }[]): Promise<DroppedFile[]> {
  const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
  if (!files.length) throw new EngineError("page/no-files", "found no readable files, expected the folder of a log");
  if (files.length > MAX_FILES || bytes > MAX_BYTES) {
    const found = `found ${files.length} files of ${Math.ceil(bytes / 1e6)} MB`;
    throw new EngineError("page/too-much", `folder: ${found}, expected at most ${MAX_FILES} files of 268 MB; drop one log`);
  }
  return Promise.all(files.map(async ({ path, file }) => ({ path, bytes: new Uint8Array(await file.arrayBuffer()) })));
}

async function walk(entry: FileSystemEntry, found: { path: string; file: File }[]): Promise<void> {
  if (found.length > MAX_FILES) return;
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    found.push({ path: entry.fullPath.replace(/^\//, ""), file });
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  // A folder is read in parts until one is empty.
  for (;;) {
    const part = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (!part.length) return;
    for (const inner of part) await walk(inner, found);
  }
}

/** All files that were dropped, including those in folders. */
export async function droppedFiles(transfer: DataTransfer): Promise<DroppedFile[]> {
  // The dropped items become invalid at the first await, so get all entries now.
  const entries = [...transfer.items].flatMap((item) => item.webkitGetAsEntry() ?? []);
  const found: { path: string; file: File }[] = [];
  for (const entry of entries) await walk(entry, found);
  return readAll(found);
}

/** All files that were picked. */
export function pickedFiles(files: FileList | null): Promise<DroppedFile[]> {
  return readAll([...(files ?? [])].map((file) => ({ path: file.webkitRelativePath || file.name, file })));
}
