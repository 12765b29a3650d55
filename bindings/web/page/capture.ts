// Pictures and turntable videos of the canvas.
import type { Stage } from './stage.js';

const turnSeconds = 6;
const framesPerSecond = 30;

export function download(bytes: Uint8Array | Blob, name: string): void {
  const blob = bytes instanceof Blob ? bytes : new Blob([bytes as BlobPart], { type: 'application/octet-stream' });
  const address = URL.createObjectURL(blob);
  Object.assign(document.createElement('a'), { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

export async function savePicture(stage: Stage, name: string): Promise<void> {
  stage.isTaken = true;
  stage.draw();
  const picture = new Promise<Blob | null>((resolve) => stage.canvas.toBlob(resolve, 'image/png')); // copies the canvas at once
  stage.isTaken = false;
  const blob = await picture;
  if (!blob) throw new Error('the browser cannot make a picture of this size');
  download(blob, `${name}.png`);
}

/** A video of one turn of the camera about the character. */
export class Turntable {
  #recorder: MediaRecorder | undefined;
  #turned = 0; // of a whole turn

  constructor(readonly stage: Stage) {}

  get isRecording(): boolean {
    return this.#recorder !== undefined;
  }

  /** Starts recording; the video is saved after one turn. Resolves at the end, also if it is stopped before, with whether it was saved. */
  async record(name: string): Promise<boolean> {
    const type = ['video/mp4', 'video/webm;codecs=vp9', 'video/webm'].find((one) => MediaRecorder.isTypeSupported(one));
    if (!type) throw new Error('this browser cannot record videos');
    const stream = this.stage.canvas.captureStream(framesPerSecond);
    const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 12e6 });
    const pieces: Blob[] = [];
    recorder.ondataavailable = ({ data }) => pieces.push(data);
    this.#turned = 0;
    this.#recorder = recorder;
    try {
      this.stage.isTaken = true;
      this.stage.draw();
      recorder.start();
      await new Promise((resolve) => (recorder.onstop = resolve));
    } finally {
      this.#recorder = undefined;
      this.stage.isTaken = false;
    }
    for (const track of stream.getTracks()) track.stop();
    if (this.#turned < 1) return false;
    download(new Blob(pieces, { type }), `${name}.${type.startsWith('video/mp4') ? 'mp4' : 'webm'}`);
    return true;
  }

  /** Turns the camera, before the picture is drawn. */
  advance(seconds: number): void {
    if (this.#recorder?.state !== 'recording') return;
    const share = Math.min(seconds / turnSeconds, 1 - this.#turned);
    this.#turned += share;
    this.stage.revolve(2 * Math.PI * share);
    if (this.#turned > 1 - 1e-9) {
      this.#turned = 1;
      this.#recorder.stop();
    }
  }

  stop(): void {
    this.#recorder?.stop();
  }
}
