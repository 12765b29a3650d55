// Playing clips: the bar below the picture, and the choice of the clip.
import { clipName, markClip } from './clip_list.js';
import type { Character } from './character.js';
import { button, element, input, setIcon } from './elements.js';
import { character, session } from './session.js';

export function setPlaying(playing: boolean): void {
  session.isPlaying = playing;
  setIcon(button('play'), playing ? 'pause' : 'play', playing ? 'Pause' : 'Play');
}

/** Plays a clip; numbers beyond the last begin again. */
export function playClip(number: number): void {
  const now = character();
  if (!now || now.clips.length === 0) return;
  const wanted = (number + now.clips.length) % now.clips.length;
  now.play(wanted, input('fade').valueAsNumber);
  markClip(wanted);
  element('playing').textContent = clipName(now.clips[wanted]!, wanted);
  setPlaying(true);
}

/** Stops, and moves on by seconds. */
export function step(seconds: number): void {
  setPlaying(false);
  character()?.step(seconds);
}

export function showTime(now: Character): void {
  const length = now.clips[now.clip]?.seconds ?? 0;
  if (session.isPlaying || document.activeElement !== input('time')) input('time').value = String(now.share);
  input('time').setAttribute('aria-valuetext', `${now.seconds.toFixed(2)} of ${length.toFixed(2)} seconds`);
  element('seconds').textContent = `${now.seconds.toFixed(2)} / ${length.toFixed(2)} s`;
}

/** Seconds of the clip that pass in so many seconds. */
export const played = (seconds: number): number => (session.isPlaying ? seconds * input('speed').valueAsNumber : 0);

button('play').addEventListener('click', () => setPlaying(!session.isPlaying));
input('time').addEventListener('input', () => {
  setPlaying(false);
  character()?.seek(input('time').valueAsNumber);
});
for (const id of ['speed', 'fade']) {
  input(id).addEventListener('input', () => (document.querySelector(`output[for=${id}]`)!.textContent = input(id).value));
}
