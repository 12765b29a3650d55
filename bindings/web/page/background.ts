// Long-running work: a worker that answers one request after another.
import type { Answers, Fault, Reply, Request } from './worker.js';

interface Waiting {
  resolve: (answer: never) => void;
  reject: (fault: Fault) => void;
  progress: (share: number) => void;
}

/** A worker that starts with the first request, and is terminated when its answers are no longer wanted. */
export class Background {
  #worker: Worker | undefined;
  #address: string | undefined; // of its text
  #next = 0;
  #waiting = new Map<number, Waiting>();

  async ask<K extends Request['kind']>(request: Request & { kind: K }, progress: (share: number) => void = () => {}): Promise<Answers[K]> {
    // The worker's text is the last element of the page.
    if (document.readyState === 'loading') await new Promise((resolve) => document.addEventListener('DOMContentLoaded', resolve, { once: true }));
    this.#worker ??= this.#start();
    const id = this.#next++;
    return new Promise<Answers[K]>((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject, progress });
      this.#worker!.postMessage({ id, request });
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

  #start(): Worker {
    this.#address ??= URL.createObjectURL(new Blob([document.getElementById('worker')!.textContent], { type: 'text/javascript' }));
    const worker = new Worker(this.#address);
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
