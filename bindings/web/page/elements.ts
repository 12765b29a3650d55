// The page's elements: those that index.html has, and new ones.

export function element<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element "${id}"`);
  return found as T;
}
export const button = (id: string) => element<HTMLButtonElement>(id);
export const input = (id: string) => element<HTMLInputElement>(id);
export const select = (id: string) => element<HTMLSelectElement>(id);

/** The bytes that an element of the page has as text in base64. */
export const embeddedBytes = (id: string): Uint8Array<ArrayBuffer> => Uint8Array.from(atob(element(id).textContent), (letter) => letter.charCodeAt(0));

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** Gives a button that has an icon alone, or an icon and a text, another icon and name. */
export function setIcon(of: HTMLButtonElement, icon: string, name: string): void {
  of.querySelector('use')!.setAttribute('href', `#icon-${icon}`);
  of.setAttribute('aria-label', name);
  of.title = name;
}

/** A labelled range with its value beside it. */
export function slider(label: string, value: number, low: number, high: number, change: (value: number) => void): HTMLElement {
  const output = make('output', {}, value.toFixed(2));
  const range = make('input', { type: 'range', min: String(low), max: String(high), step: '0.01', value: String(value) });
  range.addEventListener('input', () => {
    output.textContent = range.valueAsNumber.toFixed(2);
    change(range.valueAsNumber);
  });
  return make('label', { className: 'row' }, label, range, output);
}

/** Announces a text to screen readers. */
export function say(text: string): void {
  element('status').textContent = text;
}

export const isStill = matchMedia('(prefers-reduced-motion: reduce)');
