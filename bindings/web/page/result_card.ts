// The card that says what has become of a dropped file, and saves it.
import { button, element, make } from './elements.js';
import { bytesText, lengthText } from './units.js';

/** What the card shows. */
export interface Result {
  name: string;
  sourceSize: number;
  exactSize: number;
  /** The compact file; undefined while it is being made. */
  compactSize?: number | undefined;
  /** The largest error of the compact file, metres. */
  error?: number | undefined;
}

const isSmaller = ({ exactSize, compactSize }: Result): boolean => compactSize !== undefined && compactSize < exactSize;

/** The size of what the card's button saves. */
export const bestSize = (result: Result): number => (isSmaller(result) ? result.compactSize! : result.exactSize);

/** Shows the card in place of the welcome. */
export function showResult(result: Result): void {
  const { name, sourceSize, compactSize, error } = result;
  element('welcome').hidden = true;
  element('result').hidden = false;
  element('result-title').textContent = name;
  const isMade = compactSize !== undefined;
  element('shrinking').hidden = isMade;
  button('download').disabled = !isMade;
  button('compare').disabled = !isSmaller(result);
  const size = bestSize(result);
  element('saving').textContent = !isMade ? bytesText(sourceSize) : size === sourceSize ? bytesText(size) : `${bytesText(sourceSize)} → ${bytesText(size)}`;
  element('promise').textContent = !isMade
    ? 'Making it smaller…'
    : isSmaller(result)
      ? `${size < sourceSize ? `${Math.round(100 * (1 - size / sourceSize))} % smaller. ` : ''}No point of the skin is off by more than ${lengthText(error!)}.`
      : 'It is already as small as it gets: every number is kept.';
  element('download-text').textContent = isMade ? `Download, ${bytesText(size)}` : 'Download';
}

/** Says why there is no compact file: the exact one is saved. */
export function showNoCompact(result: Result, reason: string): void {
  showResult({ ...result, compactSize: result.exactSize });
  element('promise').textContent = reason;
}

/** Says what else is to be known: how many files there are, and warnings. */
export function showNotices(lines: string[]): void {
  element('notices').replaceChildren(...lines.map((line) => make('p', {}, line)));
}

export function hideResult(): void {
  element('result').hidden = true;
}
