// Where a link in a file leads. What it resolves to is checked, never its text: the URL parser leaves out tabs, line breaks and
// surrounding blanks, decodes %2e and reads backslashes as slashes.

/** Where relative links start if the file is in no folder of a page. No name ends in .invalid. */
const nowhere = 'http://none.invalid/folder/';

function parse(address: string, base?: string): URL | null {
  try {
    return new URL(address, base);
  } catch {
    return null;
  }
}

/** The folder that an address is in. Null if its kind has no folders, such as blob. */
function folderOf(address: string, base?: string): string | null {
  const whole = parse(address, base);
  return whole && (parse('.', whole.href)?.href ?? null);
}

/** Whether an address is that of a file in a folder or below it: same scheme, user, host and port. */
function isFileIn({ href }: URL, folder: string): boolean {
  if (!href.startsWith(folder)) return false;
  const name = href.slice(folder.length).replace(/[?#].*/, '');
  const read = name.replace(/%2e/gi, '.').replace(/%2f|%5c|\\/gi, '/'); // as some servers do
  return /[^/]$/.test(name) && !/(^|\/)\.\.(\/|$)/.test(read);
}

/**
 * The address of what a link in a file names.
 * @param path  the base of relative links, as three.js's loaders take it: the folder of the file, empty for that of the page
 * Throws if the link has a control character, if it leads nowhere, or, unless foreign links are allowed, out of the folder.
 */
export function addressOfLink(link: string, path: string, allowsForeign: boolean): string {
  if (/\p{Cc}/u.test(link)) throw new Error('its link has a control character');
  const page = folderOf(globalThis.document?.baseURI ?? globalThis.location?.href ?? nowhere) ?? nowhere;
  const folder = folderOf(path, page);
  const url = parse(link, folder ?? nowhere);
  if (url === null) throw new Error('its link is not an address');
  if (url.protocol === 'data:') return url.href;
  const isInside = isFileIn(url, folder ?? nowhere);
  if (!isInside && !allowsForeign) throw new Error('its link leaves the folder of the file');
  // What a URL modifier of three.js expects, where that is the same address.
  const plain = path + link;
  const isSame = folder === null ? isInside : parse(plain, page)?.href === url.href;
  return isSame ? plain : url.href;
}
