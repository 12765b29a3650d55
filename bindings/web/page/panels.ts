// The panels of clips, IK chains and looks.
import { listClips } from './clip_list.js';
import { button, element, input, make, select, slider } from './elements.js';
import { chainLabel } from './handles.js';
import { playClip } from './playing.js';
import { character, session, stage, stem } from './session.js';
import { snippetFor } from './snippet.js';
import { type BackdropName, backdropNames, type SurroundingsName, surroundingsNames } from './studio.js';

/** Fills the panels for what is shown. */
export function showPanels(): void {
  const now = character();
  listClips(now?.clips ?? [], playClip);
  const hasClips = (now?.clips.length ?? 0) !== 0;
  element('noclips').hidden = hasClips || !now;
  element('noclips').textContent = 'This character has no clips.';
  element('transport').hidden = !hasClips;
  element('tempo').hidden = !hasClips;
  showMorphTargets();
  showChains();
  element('detail').hidden = !now?.hasLevels;
  input('share').value = '1';
  showTriangles();
  input('bones').checked = now !== undefined && !now.hasMesh;
  stage.setSkeleton(input('bones').checked);
  input('wireframe').checked = false;
  element('snippet').textContent = snippetFor(`${stem()}.bendy`, now?.clips[now.firstClip]?.name || undefined);
}

/** Fills the panel of morph targets with their weights. */
export function showMorphTargets(): void {
  const now = character();
  const targets = now?.morphTargets ?? [];
  element('shapes').hidden = targets.length === 0;
  element('shapes').lastElementChild!.replaceChildren(
    ...targets.map(({ name, number, weight }) =>
      slider(name || `target ${number}`, now!.weights.get(number) ?? weight, Math.min(0, weight), Math.max(1, weight), (value) => {
        now!.weights.set(number, value);
        session.life?.leave(number);
      }),
    ),
  );
}

function showChains(): void {
  const now = character();
  const hasNone = (now?.chains.length ?? 0) === 0;
  element('nochains').hidden = !hasNone || !now;
  element('haschains').hidden = hasNone;
  element('chains').replaceChildren(
    ...(now?.limbs ?? []).map((chain) => {
      const free = make('button', { type: 'button' }, 'Let go');
      free.setAttribute('aria-label', `Let go of the ${chainLabel(chain)}`);
      free.addEventListener('click', () => now?.letGo(chain.number));
      return make('div', { className: 'row' }, chainLabel(chain), make('output', { id: `reached-${chain.number}` }), free);
    }),
  );
  input('look').checked = now?.lookChain !== undefined;
  input('look').disabled = now?.lookChain === undefined;
}

/** Says how far each chain has come. */
export function showReached(): void {
  const now = character();
  for (const { number } of now?.limbs ?? []) element(`reached-${number}`).textContent = now!.results.get(number) ?? '';
}

function showTriangles(): void {
  element('triangles').textContent = character()?.triangles.toLocaleString('en') ?? '';
}

input('share').addEventListener('input', () => {
  character()?.setShare(input('share').valueAsNumber);
  showTriangles();
});
select('surroundings').append(...surroundingsNames.map((name) => make('option', {}, name)));
select('surroundings').addEventListener('change', () => stage.setSurroundings(select('surroundings').value as SurroundingsName));
select('backdrop').append(...backdropNames.map((name) => make('option', {}, name)));
for (const id of ['backdrop', 'colour']) {
  element(id).addEventListener('input', () => {
    input('colour').hidden = select('backdrop').value !== 'Colour';
    stage.setBackdrop(select('backdrop').value as BackdropName, input('colour').value);
  });
}
input('exposure').addEventListener('input', () => {
  stage.setExposure(input('exposure').valueAsNumber);
  document.querySelector('output[for=exposure]')!.textContent = input('exposure').value;
});
input('bones').addEventListener('change', () => stage.setSkeleton(input('bones').checked));
input('wireframe').addEventListener('change', () => stage.setWireframe(input('wireframe').checked));
input('show-handles').addEventListener('change', () => (element('handles').hidden = !input('show-handles').checked));
button('frame').addEventListener('click', () => stage.resetView());
