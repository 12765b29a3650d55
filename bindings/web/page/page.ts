// The parts of the page together: its keys, and its frames.
import { updateComparison } from './comparing.js';
import { input } from './elements.js';
import { recordTurn, takePicture, toggleFullscreen, turntable } from './filming.js';
import { listenToKeys } from './keys.js';
import { showReached } from './panels.js';
import { played, playClip, setPlaying, showTime, step } from './playing.js';
import { character, handles, session, stage } from './session.js';
import { selectTab } from './tabs.js';

export { openExample } from './showing.js';

const frameStep = 1 / 30; // seconds, of the keys
const mostSeconds = 0.1; // that a frame stands for

const sign = (key: string, plus: string, minus: string): number => (key === plus ? 1 : key === minus ? -1 : 0);

listenToKeys([
  {
    keys: ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'],
    text: 'turn the picture that has the focus',
    onPicture: true,
    run: (key) => stage.turn(sign(key, 'ArrowRight', 'ArrowLeft'), sign(key, 'ArrowUp', 'ArrowDown')),
  },
  { keys: ['+', '-'], also: ['='], text: 'come nearer, go away', run: (key) => stage.turn(0, 0, key === '-' ? -1 : 1) },
  { keys: ['0'], text: 'show the whole character', run: () => stage.resetView() },
  { keys: [' '], text: 'play or pause', run: () => setPlaying(!session.isPlaying) },
  { keys: [',', '.'], text: 'one step back or on', run: (key) => step(sign(key, '.', ',') * frameStep) },
  { keys: ['[', ']'], text: 'the clip before or after', run: (key) => playClip((character()?.clip ?? 0) + sign(key, ']', '[')) },
  { keys: ['o'], text: 'open files', run: () => input('files').click() },
  { keys: ['p'], text: 'save a picture', run: takePicture },
  { keys: ['v'], text: 'save a turntable video', run: () => void recordTurn() },
  { keys: ['f'], text: 'full screen', run: toggleFullscreen },
]);
handles.onHold = (chain) => (chain === undefined ? stage.hideRanges() : stage.showRanges(chain));
selectTab('move');

function drawFrame(seconds: number): void {
  const now = character();
  if (now) {
    const pointer = input('look').checked ? stage.pointerTarget() : undefined;
    now.obeysConstraints = input('constrained').checked;
    if (session.isPlaying) session.life?.advance(seconds);
    now.update(played(seconds), seconds, pointer);
    updateComparison(seconds, pointer);
    showTime(now);
    showReached();
  }
  turntable.advance(seconds);
  stage.draw();
  handles.place();
}

/** Draws a frame whenever the browser wants one; `first` is called after the first. */
export function startDrawing(first: () => void): void {
  let before = performance.now();
  const frame = (now: number): void => {
    drawFrame(Math.min(Math.max(now - before, 0) / 1000, mostSeconds));
    before = now;
    requestAnimationFrame(frame);
  };
  frame(before);
  first();
}

// For tests that drive the page.
Object.assign(globalThis, {
  bendyPage: {
    stage,
    handlePlace: (chain: number) => handles.placeOf(chain),
    get character() { return character(); },
    get comparison() { return session.comparison; },
  },
});
