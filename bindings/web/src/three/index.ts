/**
 * Bendy's characters in three.js: a loader, and an animator and a crowd that use Bendy's runtime.
 *
 * @packageDocumentation
 */
export { type AnimatorOptions, type AnimatorPlayOptions, type AnimatorReachOptions, BendyAnimator } from './animator.js';
export { type BendyCharacter, cloneCharacter, setLevelOfDetail } from './character.js';
export { BendyCrowd, type CrowdPlayOptions } from './crowd.js';
export { type GltfChain, type GltfRig, GltfRigPlugin } from './gltf_rig.js';
export { BendyLoader } from './loader.js';
export type { Part } from './parts.js';
export type { Ktx2Decoder } from './textures.js';
