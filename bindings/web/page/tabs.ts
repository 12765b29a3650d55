// The tabs beside the picture.
import { button, element } from './elements.js';

const tabs = ['move', 'reach', 'look', 'save', 'messages', 'inspect'];
const listeners: ((name: string) => void)[] = [];
let selected = '';

export const selectedTab = (): string => selected;
export const onTab = (listener: (name: string) => void): number => listeners.push(listener);

export function selectTab(name: string): void {
  selected = name;
  for (const tab of tabs) {
    const chosen = button(`tab-${tab}`);
    chosen.setAttribute('aria-selected', String(tab === name));
    chosen.tabIndex = tab === name ? 0 : -1;
    element(chosen.getAttribute('aria-controls')!).hidden = tab !== name;
  }
  document.querySelector('aside')!.classList.toggle('wide', name === 'inspect');
  for (const listener of listeners) listener(name);
}

for (const tab of tabs) button(`tab-${tab}`).addEventListener('click', () => selectTab(tab));
element('tabs').addEventListener('keydown', (event) => {
  const at = tabs.indexOf(selected);
  const next = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: -1 }[event.key];
  if (next === undefined) return;
  event.preventDefault();
  event.stopPropagation();
  selectTab(tabs[(next + tabs.length) % tabs.length]!);
  button(`tab-${selected}`).focus();
});
