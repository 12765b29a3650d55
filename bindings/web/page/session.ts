// What the page shows at the moment. Its parts read it; opening and comparing change it.
import { Background } from './background.js';
import type { Character } from './character.js';
import type { Comparison } from './comparison.js';
import { element } from './elements.js';
import { Handles } from './handles.js';
import type { Life } from './life.js';
import type { Opened } from './opening.js';
import { Stage } from './stage.js';

export const background = new Background();
export const stage = new Stage(element<HTMLCanvasElement>('view'));
export const handles = new Handles(element('handles'), stage);

interface Session {
  shown: Opened | undefined;
  comparison: Comparison | undefined;
  /** Of the first character. */
  life: Life | undefined;
  isPlaying: boolean;
}

export const session: Session = { shown: undefined, comparison: undefined, life: undefined, isPlaying: false };

export const character = (): Character | undefined => session.shown?.character;

/** The name of what is shown, for files that are made of it. */
export const stem = (): string => (session.shown?.name ?? 'character').replace(/\.[^.]*$/, '');
