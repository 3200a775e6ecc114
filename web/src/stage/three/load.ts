/** The 3-D library comes when somebody asks for it, and once. */
export const loadOverlay = once(async () => (checkWebgl(), (await import('./overlay')).ShadedOverlay));
export const loadSpace = once(async () => (checkWebgl(), (await import('./space')).SpaceView));

/** This browser draws no 3-D pictures. */
export class NoWebgl extends Error {}

function checkWebgl(): void {
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context) throw new NoWebgl('no WebGL');
  context.getExtension('WEBGL_lose_context')?.loseContext();
}

function once<T>(load: () => Promise<T>): () => Promise<T> {
  let loaded: Promise<T> | null = null;
  return () => (loaded ??= load());
}
