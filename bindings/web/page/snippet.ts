// The lines that show the character in a program.
import { button, element } from './elements.js';

/** Three lines for three.js, which a test runs. */
export function snippetFor(file: string, clip: string | undefined): string {
  const quoted = (text: string): string => `'${text.replace(/[\\']/g, '\\$&').replace(/[\n\r\u2028\u2029]/g, ' ')}'`;
  const play = clip === undefined ? '' : `.play(${quoted(clip)})`;
  return [
    "import { BendyAnimator, BendyLoader } from 'bendy/three';",
    `const character = await new BendyLoader().loadAsync(${quoted(encodeURIComponent(file))}); scene.add(character.scene);`,
    `const animator = new BendyAnimator(character)${play}; // each frame: animator.update(seconds)`,
  ].join('\n');
}

async function copy(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const range = document.createRange(); // without the permission: leave it selected, to be copied by hand
    range.selectNodeContents(element('snippet'));
    getSelection()!.removeAllRanges();
    getSelection()!.addRange(range);
    document.execCommand('copy');
  }
}

button('copy').addEventListener('click', async () => {
  await copy(element('snippet').textContent);
  const label = button('copy').querySelector('span')!;
  label.textContent = 'Copied';
  setTimeout(() => (label.textContent = 'Copy'), 2000);
});
