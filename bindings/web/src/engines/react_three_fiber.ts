'use client';
/**
 * Bendy's characters in react-three-fiber: `bendy/react-three-fiber`.
 *
 *     <Canvas>
 *       <Suspense fallback={null}>
 *         <Bendy src="fox.bendy" clip="Walk" position={[0, 0, -2]} />
 *       </Suspense>
 *     </Canvas>
 *
 * @packageDocumentation
 */
import { type ThreeElements, useFrame, useLoader } from '@react-three/fiber';
import { createElement, type ReactElement, type Ref, useEffect, useImperativeHandle, useMemo, useRef, useState } from 'react';
import type { Clip, Key } from '../index.js';
import { BendyAnimator, type AnimatorOptions, type AnimatorPlayOptions, type BendyCharacter, BendyLoader, cloneCharacter } from '../three/index.js';

/** Loads a character, suspending until it is there. All components that load the same address share it. */
export function useBendy(src: string): BendyCharacter {
  return useLoader(BendyLoader, src);
}

/** Makes an animator for a character, and plays what `animator.play` starts, frame by frame. Null in the first render. */
export function useBendyAnimator(
  character: BendyCharacter,
  { skin = 'gpu', method = 'linear', joints = 'all', paused = false, onFrame }: AnimatorOptions & Pick<BendyProps, 'paused' | 'onFrame'> = {},
): BendyAnimator | null {
  const [animator, setAnimator] = useState<BendyAnimator | null>(null);
  const current = useRef<BendyAnimator | null>(null);
  useEffect(() => {
    const made = new BendyAnimator(character, { skin, method, joints });
    current.current = made;
    setAnimator(made);
    return () => {
      current.current = null;
      made.dispose();
    };
  }, [character, skin, method, joints]);
  useFrame((_, seconds) => current.current?.update(paused ? 0 : seconds, onFrame));
  return animator;
}

/** What `Bendy` takes, beside the properties of a group. */
export interface BendyProps extends AnimatorOptions, Omit<AnimatorPlayOptions, 'easing'>, Omit<ThreeElements['group'], 'ref'> {
  /** The address of the file. */
  src: string;
  /** The clip that plays, by name or number; at rest if not given. A change fades, in `fade` seconds: 0.3 if not given. */
  clip?: Key<Clip>;
  /** Whether time stands still. */
  paused?: boolean;
  /** Called in each frame before the pose is written: it may blend and reach. */
  onFrame?: (animator: BendyAnimator) => void;
  /** Receives the animator. */
  ref?: Ref<BendyAnimator | null>;
}

/** A character that plays a clip. Several components with the same `src` share its geometries and materials. */
export function Bendy(props: BendyProps): ReactElement {
  const { src, clip, fade = 0.3, speed, loop, skin, method, joints, paused, onFrame, ref, children, ...group } = props;
  const shared = useBendy(src);
  const character = useMemo(() => cloneCharacter(shared), [shared]);
  const animator = useBendyAnimator(character, {
    ...(skin && { skin }),
    ...(method && { method }),
    ...(joints && { joints }),
    ...(paused && { paused }),
    ...(onFrame && { onFrame }),
  });
  useImperativeHandle<BendyAnimator | null, BendyAnimator | null>(ref, () => animator, [animator]);
  useEffect(() => {
    if (animator === null || clip === undefined || animator.pose.disposed) return;
    animator.play(clip, { fade, ...(speed !== undefined && { speed }), ...(loop !== undefined && { loop }) });
  }, [animator, clip, speed, loop]);
  return createElement('group', group as object, createElement('primitive', { object: character.scene }), children);
}
