// The page's main script: shows the poster, then the example, and draws each frame.
import { element, make } from './elements.js';

/** Resolves when the poster has been painted: making a picture by WebGL keeps the browser from painting for a while. */
function posterPainted(): Promise<void> {
  return new Promise((resolve) => {
    const observer = new PerformanceObserver((list) => list.getEntriesByName('first-contentful-paint').length !== 0 && resolve());
    observer.observe({ type: 'paint', buffered: true });
    setTimeout(resolve, 1500); // not every browser reports it, and none paints a hidden page
  });
}

async function start(): Promise<void> {
  const { openExample, startDrawing } = await import('./page.js'); // the modules of the page begin to work when they are imported
  await openExample();
  startDrawing(() => {
    element('poster').remove();
    performance.mark('first-picture');
  });
}

/** Says in the place of the welcome why nothing will move. */
function showFailure(error: unknown): void {
  const hasWebgl = document.createElement('canvas').getContext('webgl2') !== null;
  const reason = hasWebgl ? String(error) : 'This browser offers no WebGL 2, which the page draws with.';
  element('welcome').replaceChildren(make('h2', { id: 'welcome-title' }, 'No picture'), make('p', {}, reason));
}

void posterPainted()
  .then(start)
  .catch(showFailure)
  .finally(() => document.documentElement.classList.remove('early'));
