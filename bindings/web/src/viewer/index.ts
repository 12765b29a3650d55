/**
 * `<bendy-viewer src="fox.bendy" clip="Walk" poster="fox.png" alt="A fox that walks" camera-controls></bendy-viewer>`: importing
 * `bendy/viewer` defines the element.
 *
 * @packageDocumentation
 */
import { BendyViewerElement } from './element.js';

export { BendyViewerElement, type ViewerEvents, type ViewerProgress } from './element.js';

declare global {
  interface HTMLElementTagNameMap {
    'bendy-viewer': BendyViewerElement;
  }
}

// On a server there are no elements, and another copy of the package may have been here first.
if (typeof customElements !== 'undefined' && customElements.get('bendy-viewer') === undefined) {
  customElements.define('bendy-viewer', BendyViewerElement);
}
