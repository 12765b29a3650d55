// Work that takes a while: its bar over the picture, and what went wrong.
import { element } from './elements.js';
import { showMessages } from './messages.js';
import { faultOf, isStopped } from './opening.js';
import { selectTab } from './tabs.js';

/** Shows a text with a bar; none for an empty text. */
export function setBusy(text: string): void {
  element('busy').hidden = text === '';
  element('doing').textContent = text;
  element<HTMLProgressElement>('progress').removeAttribute('value');
}

export const showProgress = (share: number): number => (element<HTMLProgressElement>('progress').value = share);

/** Lists what went wrong, and shows the list. */
export function showFailure(error: unknown): void {
  if (isStopped(error)) return;
  showMessages('This cannot be done.', [faultOf(error)], []);
  selectTab('messages');
}

/** Does work below a bar; a fault is listed among the messages. */
export async function working(text: string, work: () => Promise<void>): Promise<void> {
  setBusy(text);
  try {
    await work();
  } catch (error) {
    showFailure(error);
  }
  setBusy('');
}
