import init, { Matcher, type Match as RawMatch } from '../pkg/core/fluoropose_wasm.js';
import wasmAddress from '../pkg/core/fluoropose_wasm_bg.wasm?url';
import type { ComponentName } from '../document/types';
import type { Match, MatchedCandidate, MatchInput, PoseProtocol } from '../engine/protocol';
import { serve } from './serve';

/** Holds both components' libraries and finds poses in them. */
const ready = init({ module_or_path: wasmAddress });
const matchers = new Map<ComponentName, Matcher>();

serve<PoseProtocol>({
  open: async ({ component, bytes, mesh }) => {
    await ready;
    const matcher = new Matcher(bytes);
    if (mesh) matcher.lendModel(mesh.vertices, mesh.triangles);
    matchers.get(component)?.free();
    matchers.set(component, matcher);
    return { views: matcher.views, bytes: bytes.length };
  },
  match: (input) => found('matchOutline', input),
  refine: (input) => found('refineOutline', input),
});

async function found(how: 'matchOutline' | 'refineOutline', { component, outline, camera }: MatchInput): Promise<Match> {
  await ready;
  const matcher = matchers.get(component);
  if (!matcher) throw new Error(`The library of the ${component} is not open`);
  const startedAt = performance.now();
  const match = matcher[how](outline, camera.text, camera.width, camera.height);
  try {
    return copied(match, matcher, performance.now() - startedAt);
  } finally {
    match.free();
  }
}

function copied(found: RawMatch, matcher: Matcher, milliseconds: number): Match {
  const { canonicalSize, canonicalArea } = matcher;
  const candidates = Array.from({ length: found.count }, (_, index) => candidateOf(found, index, canonicalSize));
  return { candidates, canonicalSize, canonicalArea, clipped: found.clipped, milliseconds };
}

function candidateOf(found: RawMatch, index: number, size: number): MatchedCandidate {
  const [x = 0, y = 0, z = 0, zRot = 0, xRot = 0, yRot = 0] = found.pose(index) ?? [];
  return {
    pose: { x, y, z, zRot, xRot, yRot },
    unmatched: found.unmatched(index) ?? 0,
    drawn: found.drawn(index) ?? null,
    residual: found.residual(index) ?? null,
    atBorder: found.atBorder(index) ?? false,
    picture: { size, input: bits(found.inputBits(index)), view: bits(found.viewBits(index)) },
  };
}

function bits(copy: Uint8Array | undefined): Uint8Array<ArrayBuffer> {
  return (copy ?? new Uint8Array()) as Uint8Array<ArrayBuffer>;
}
