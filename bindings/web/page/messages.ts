// What the readers and the loader said: faults with their places, and warnings.
import { element, make } from './elements.js';
import type { Fault, Warning } from './worker.js';

function faultLine({ code, message, path, offset }: Fault): HTMLLIElement {
  const place = [path, offset === undefined || path === '' ? '' : `offset ${offset.toLocaleString('en')}`].filter(Boolean).join(', ');
  const line = make('li', {}, code ? make('code', {}, code) : '', ` ${message}`);
  if (place && !message.includes(path)) line.append(make('br'), make('code', { className: 'quiet' }, place));
  return line;
}

function warningLine({ message, place, count }: Warning): HTMLLIElement {
  const line = make('li', {}, message + (count > 1 ? ` (${count} times)` : ''));
  if (place) line.prepend(make('code', {}, place), ' ');
  return line;
}

/** Lists faults and warnings below a verdict, and counts them at the tab. */
export function showMessages(verdict: string, faults: Fault[], warnings: Warning[]): void {
  const line = element('verdict');
  line.className = faults.length === 0 ? 'good' : 'bad';
  line.textContent = verdict;
  element('faults').replaceChildren(...faults.map(faultLine));
  element('warned').hidden = warnings.length === 0;
  element('warnings').replaceChildren(...warnings.map(warningLine));
  const count = faults.length + warnings.length;
  element('message-count').textContent = count === 0 ? '' : String(count);
  element('message-count').hidden = count === 0;
}

/** The verdict on a file that cannot be shown. */
export function refusal(faults: Fault[]): string {
  return faults.length === 1 ? 'The file cannot be shown: it has a fault.' : `The file cannot be shown: it has ${faults.length} faults.`;
}
