// Long-running work: a worker that answers one request after another.
import { embeddedBytes } from './elements.js';
import type { Answers, Fault, Reply, Request } from './worker.js';

interface Waiting {
  resolve: (answer: never) => void;
  reject: (fault: Fault) => void;
  progress: (share: number) => void;
}

/** The address of the worker's text, which is the last element of the page. */
async function unpackWorker(): Promise<string> {
  if (document.readyState === 'loading') await new Promise((resolve) => document.addEventListener('DOMContentLoaded', resolve, { once: true }));
  const unpacked = new Blob([embeddedBytes('worker')]).stream().pipeThrough(new DecompressionStream('gzip'));
  return URL.createObjectURL(new Blob([await new Response(unpacked).arrayBuffer()], { type: 'text/javascript' }));
}

/** A worker that starts with the first request, and is terminated when its answers are no longer wanted. */
export class Background {
  #worker: Worker | undefined;
  #address: Promise<string> | undefined; // of its text
  #next = 0;
  #waiting = new Map<number, Waiting>();

  ask<K extends Request['kind']>(request: Request & { kind: K }, progress: (share: number) => void = () => {}): Promise<Answers[K]> {
    const id = this.#next++;
    return new Promise<Answers[K]>((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject, progress });
      void this.#post(id, request);
    });
  }

  /** Ends the work in progress: its requests are rejected with STOPPED. */
  stop(): void {
    if (this.#waiting.size === 0) return;
    this.#end({ code: 'STOPPED', message: 'stopped', path: '' });
  }

  #end(fault: Fault): void {
    this.#worker?.terminate();
    this.#worker = undefined;
    for (const { reject } of this.#waiting.values()) reject(fault);
    this.#waiting.clear();
  }

  async #post(id: number, request: Request): Promise<void> {
    try {
      const address = await (this.#address ??= unpackWorker());
      if (!this.#waiting.has(id)) return; // stopped
      this.#worker ??= this.#start(address);
      this.#worker.postMessage({ id, request });
    } catch (error) {
      this.#end({ code: '', message: String(error), path: '' });
    }
  }

  #start(address: string): Worker {
    const worker = new Worker(address);
    worker.onmessage = ({ data }: MessageEvent<Reply>) => {
      const waiting = this.#waiting.get(data.id);
      if (!waiting) return;
      if ('progress' in data) return waiting.progress(data.progress);
      this.#waiting.delete(data.id);
      if ('fault' in data) waiting.reject(data.fault);
      else waiting.resolve(data.answer as never);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.#end({ code: '', message: event.message || 'the worker has failed', path: '' });
    };
    return worker;
  }
}
