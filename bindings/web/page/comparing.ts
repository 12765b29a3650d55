// The exact character beside the compact one.
import { Character } from './character.js';
import { Comparison, rampGradient } from './comparison.js';
import { button, element } from './elements.js';
import { linkedFile } from './files.js';
import { compactFile } from './saving.js';
import { session, stage } from './session.js';
import { lengthText } from './units.js';
import { working } from './working.js';

async function compare(): Promise<void> {
  const of = session.shown;
  if (!of?.character || session.comparison) return;
  await working('Opening the compact file', async () => {
    const { bytes, bound } = await compactFile(of);
    const second = await Character.open(bytes, (uri) => linkedFile(of, uri));
    if (session.shown !== of || session.comparison) return second.dispose();
    session.comparison = new Comparison(of.character!, second, bound);
    stage.show([of.character!, second]);
    element('most').textContent = lengthText(bound);
    element('legend').hidden = false;
    button('end-compare').focus();
  });
}

/** Shows the exact character alone again. */
export function endComparison(): void {
  const { comparison } = session;
  if (!comparison) return;
  session.comparison = undefined;
  element('legend').hidden = true;
  stage.show([comparison.exact]);
  comparison.compact.dispose();
}

/** Moves the compact character as the exact one moves. */
export function updateComparison(seconds: number, pointer: Parameters<Character['update']>[2]): void {
  const { comparison } = session;
  if (!comparison) return;
  comparison.compact.update(0, seconds, pointer);
  comparison.update();
  element('worst').textContent = `now ${lengthText(comparison.worst)}`;
}

button('compare').addEventListener('click', () => void compare());
button('end-compare').addEventListener('click', () => {
  endComparison();
  button('compare').focus();
});
element('ramp').style.background = rampGradient;
