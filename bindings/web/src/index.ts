/**
 * Bendy's runtime: opens animated characters, poses them and skins their vertices. docs/web.md is the guide.
 *
 * Lengths are metres, angles radians, times seconds; model space is right-handed, y is up; quaternions are x, y, z, w; matrices are
 * 16 numbers, column by column.
 *
 * @packageDocumentation
 */
export { Binding, type BindingOptions } from './binding.js';
export { BodyReach, type BodyReached, type BodyReachOptions, type Effector, type EffectorTarget } from './body_reach.js';
export { Bounds, type Box } from './bounds.js';
export { Clip, Curve, type Marker, type Track } from './clip.js';
export { Crowd } from './crowd.js';
export { BendyError, type ErrorKind } from './errors.js';
export type { Easing, Interpolation, LoopMode, RestPoses, Role, Solver, StreamKind } from './generated/bindings.js';
export { type Item, Items, type Key } from './items.js';
export { hasSimd, init, type LoadOptions, loadRuntime } from './load.js';
export { LevelOfDetail } from './lod.js';
export { Mesh, MorphTarget, type StoredArray, Stream } from './mesh.js';
export { Model, type OpenOptions } from './model.js';
export type { PointLike, RotationLike } from './numbers.js';
export type {
  Chain,
  Constraint,
  Image,
  Joint,
  JointSubmesh,
  Material,
  Quaternion,
  Submesh,
  Texture,
  TextureUse,
  Transform,
  Vector3,
} from './parts.js';
export { CrossFade, ease, Fade, Playback, type Playing, type PlayOptions } from './play.js';
export { ReachState } from './reach_state.js';
export { Pose, type ReachOptions, type ReachRequest, type ReachResult, SkinnedVertices, type SkinOptions, type SocketOptions, type TransformParts } from './pose.js';
export { Retarget, type Retargeted, type RetargetOptions, RetargetState } from './retarget.js';
export { blendMotions, composeMotions, motionMatrix, type RootAxes, type RootMotion, RootPath } from './root_motion.js';
export { Handle, Runtime } from './runtime.js';
