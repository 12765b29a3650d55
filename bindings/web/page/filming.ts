// The buttons that save a picture or a video, and that fill the screen.
import { savePicture, Turntable } from './capture.js';
import { button, element, say, setIcon } from './elements.js';
import { stage, stem } from './session.js';
import { showFailure } from './working.js';

export const turntable = new Turntable(stage);

export const takePicture = (): void => void savePicture(stage, stem()).then(() => say('The picture is saved'), showFailure);

/** Records one turn, or ends the recording. */
export async function recordTurn(): Promise<void> {
  if (turntable.isRecording) return turntable.stop();
  setIcon(button('video'), 'stop', 'Stop the video');
  button('video').classList.add('recording');
  say('Recording one turn');
  try {
    say((await turntable.record(stem())) ? 'The video is saved' : 'The video is not saved');
  } catch (error) {
    showFailure(error);
  }
  button('video').classList.remove('recording');
  setIcon(button('video'), 'video', 'Save a turntable video');
}

export function toggleFullscreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void element('stage').requestFullscreen().catch(showFailure);
}

button('picture').addEventListener('click', takePicture);
button('video').addEventListener('click', () => void recordTurn());
button('fullscreen').addEventListener('click', toggleFullscreen);
button('fullscreen').hidden = !document.fullscreenEnabled;
document.addEventListener('fullscreenchange', () => {
  const isFull = document.fullscreenElement !== null;
  setIcon(button('fullscreen'), isFull ? 'shrink' : 'grow', isFull ? 'Leave full screen' : 'Full screen');
});
