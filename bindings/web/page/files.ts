// The files that somebody drops or chooses: which of them are characters, and which belong to these.

/** Of characters; those that refer to other files come first. */
export const suffixes = ['.gltf', '.x', '.glb', '.vrm', '.vrma', '.md2', '.bvh', '.bendy'];
const companions = ['.bin', '.json', '.png', '.jpg', '.jpeg', '.webp', '.ktx2', '.tga', '.bmp', '.dds', '.pcx'];
/** For `accept` of a file input. */
export const acceptedSuffixes = [...suffixes, ...companions].join();

/** Files by their paths, and the one to show. */
export interface Given {
  files: Record<string, Uint8Array>;
  main: string;
}

export const baseName = (path: string): string => path.replace(/.*\//, '');
/** Whether a character may use the file. */
export const isCompanion = (name: string): boolean => companions.some((suffix) => name.toLowerCase().endsWith(suffix));
export const isRig = (name: string): boolean => name.toLowerCase().endsWith('.rig.json');

/** The characters among files, those that refer to other files first. */
export function charactersOf(names: string[]): string[] {
  return suffixes.flatMap((suffix) => names.filter((name) => name.toLowerCase().endsWith(suffix)));
}

export async function readFiles(list: Iterable<File>): Promise<Record<string, Uint8Array>> {
  const files: Record<string, Uint8Array> = {};
  for (const file of list) {
    let name = file.webkitRelativePath || file.name;
    // Files of several folders may have one name: the second one is kept as "2/name".
    for (let number = 2; files[name] !== undefined; ++number) name = `${number}/${file.webkitRelativePath || file.name}`;
    files[name] = new Uint8Array(await file.arrayBuffer());
  }
  return files;
}

/** The file that a link in the main one names: relative to it, or the only file with that name anywhere. */
export function linkedFile({ files, main }: Given, uri: string): Uint8Array | undefined {
  let link = uri.replace(/\\/g, '/');
  try {
    link = decodeURIComponent(link);
  } catch {} // the name contains a literal %
  const path = `${main.replace(/[^/]*$/, '')}${link.replace(/^(\.\/)+/, '')}`;
  const wanted = baseName(link).toLowerCase();
  const alike = Object.keys(files).filter((name) => baseName(name).toLowerCase() === wanted);
  const found = files[path] !== undefined ? path : alike.length === 1 ? alike[0]! : undefined;
  return found === undefined || found === main ? undefined : files[found];
}

/** A file of a folder, with its path. */
const placed = (file: File, path: string): File => Object.defineProperty(file, 'webkitRelativePath', { value: path });

/** The files in a folder, for browsers that offer no handles. */
async function filesIn(entry: FileSystemEntry): Promise<File[]> {
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    return [placed(file, entry.fullPath.replace(/^\//, ''))];
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const files: File[] = [];
  for (;;) {
    const entries = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return files;
    for (const one of entries) files.push(...(await filesIn(one)));
  }
}

type Handle = (FileSystemFileHandle & { kind: 'file' }) | (FileSystemDirectoryHandle & { kind: 'directory'; values(): AsyncIterable<Handle> });

async function filesOf(handle: Handle, path: string): Promise<File[]> {
  if (handle.kind === 'file') return [placed(await handle.getFile(), path)];
  const files: File[] = [];
  for await (const one of handle.values()) files.push(...(await filesOf(one, `${path}/${one.name}`)));
  return files;
}

/** Chromium reads no entries on a page that was opened as a file, but files and handles. */
async function filesOfItem(item: DataTransferItem & { getAsFileSystemHandle?(): Promise<Handle | null> }): Promise<File[]> {
  const entry = item.webkitGetAsEntry();
  const file = item.getAsFile();
  if (!entry?.isDirectory) return file === null ? [] : [file];
  const handle = await item.getAsFileSystemHandle?.();
  return handle ? filesOf(handle, handle.name) : filesIn(entry);
}

/** The dropped files, including those in folders, with their paths. Call it in the event: items are gone after it. */
export async function droppedFiles(items: DataTransferItemList): Promise<File[]> {
  return (await Promise.all([...items].filter(({ kind }) => kind === 'file').map(filesOfItem))).flat();
}
