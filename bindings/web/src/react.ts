'use client';
/**
 * `<BendyViewer src="fox.bendy" clip="Walk" alt="A fox that walks" cameraControls />`: the element of `bendy/viewer` for React.
 *
 * @packageDocumentation
 */
import { createElement, type HTMLAttributes, type ReactElement, type Ref, useEffect, useImperativeHandle, useRef } from 'react';
import type { BendyError } from './index.js';
import type { BendyCharacter } from './three/index.js';
import type { BendyViewerElement, ViewerProgress } from './viewer/index.js';
import './viewer/index.js';

/** What `BendyViewer` takes, beside what every element takes. The attributes are those of the element. */
export interface BendyViewerProps extends Omit<HTMLAttributes<HTMLElement>, 'onLoad' | 'onError' | 'onProgress' | 'children'> {
  src: string;
  motions?: string | undefined;
  clip?: string | undefined;
  poster?: string | undefined;
  alt?: string | undefined;
  cameraControls?: boolean | undefined;
  paused?: boolean | undefined;
  onLoad?: (character: BendyCharacter) => void;
  /** Without it, errors are on the console. */
  onError?: (error: BendyError) => void;
  onProgress?: (progress: ViewerProgress) => void;
  /** Receives the element. */
  ref?: Ref<BendyViewerElement | null>;
}

/** Shows a character. */
export function BendyViewer({ cameraControls, paused, className, onLoad, onError, onProgress, ref, ...others }: BendyViewerProps): ReactElement {
  const element = useRef<BendyViewerElement>(null);
  const handlers = useRef({ load: onLoad, error: onError, progress: onProgress });
  useEffect(() => {
    handlers.current = { load: onLoad, error: onError, progress: onProgress };
  });
  useImperativeHandle<BendyViewerElement | null, BendyViewerElement | null>(ref, () => element.current, []);
  useEffect(() => {
    const viewer = element.current!;
    const stop = new AbortController();
    for (const type of ['load', 'error', 'progress'] as const) {
      const call = (event: CustomEvent): void => {
        const handler = handlers.current[type];
        if (handler === undefined) return;
        event.preventDefault(); // the console need not show what a handler receives
        handler(event.detail as never);
      };
      viewer.addEventListener(type, call, { signal: stop.signal });
    }
    return () => stop.abort();
  }, []);
  const attributes = { ...others, class: className, 'camera-controls': cameraControls ? '' : undefined, paused: paused ?? false };
  return createElement('bendy-viewer', { ...attributes, ref: element });
}
