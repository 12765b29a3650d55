// The keys of the page, and the dialog that lists them.
import { button, element, make } from './elements.js';

export interface Key {
  /** As `KeyboardEvent.key` names them. */
  keys: string[];
  /** Keys that do the same and are not listed. */
  also?: string[];
  /** What they do, for the list. */
  text: string;
  run: (key: string) => void;
  /** Only while the picture has the focus. */
  onPicture?: boolean;
}

const names: Record<string, string> = { ' ': 'Space', ArrowLeft: '←', ArrowRight: '→', ArrowUp: '↑', ArrowDown: '↓', Escape: 'Esc', Delete: 'Del', PageUp: 'PgUp', PageDown: 'PgDn' };
/** The keys of a handle that has the focus, which handles.ts takes. */
const handleKeys = [
  { keys: ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'PageUp', 'PageDown'], text: 'move the handle that has the focus' },
  { keys: ['Escape', 'Delete'], text: 'let go of it' },
];

const takesText = (target: EventTarget | null): boolean =>
  (target instanceof HTMLInputElement && target.type !== 'checkbox') || target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;

/** Listens to keys, and fills the dialog. */
export function listenToKeys(keys: Key[]): void {
  const dialog = element<HTMLDialogElement>('keys');
  const all = [...keys, { keys: ['?'], text: 'show these keys', run: () => dialog.showModal() }];
  element('key-list').replaceChildren(
    ...[...all, ...handleKeys].flatMap(({ keys, text }) => [
      make('dt', {}, ...keys.flatMap((key) => [make('kbd', {}, names[key] ?? key), ' '])),
      make('dd', {}, text),
    ]),
  );
  button('show-keys').addEventListener('click', () => dialog.showModal());
  button('hide-keys').addEventListener('click', () => dialog.close());
  addEventListener('keydown', (event) => {
    const { target, key } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || takesText(target) || dialog.open) return;
    if (key === ' ' && (target instanceof HTMLButtonElement || target instanceof HTMLInputElement)) return;
    const found = all.find(({ keys, also, onPicture }: Key) => (keys.includes(key) || also?.includes(key)) && (!onPicture || (target as Element).id === 'view'));
    if (!found) return;
    event.preventDefault();
    found.run(key);
  });
}
