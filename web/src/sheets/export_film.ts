import { useEffect, useMemo, useState } from 'preact/hooks';
import { useApp } from '../commands/app';
import { overlayLook, OverlayFrames } from '../commands/overlay_film';
import type { State } from '../document/store';
import { overlayWorker } from '../workers/start';
import type { FilmType } from '../workers/protocol/overlay';

/** What kind of film this browser writes of these frames; null where none, undefined while it is asked. */
export function useFilmType(state: State): FilmType | null | undefined {
  const [type, setType] = useState<FilmType | null | undefined>(undefined);
  const { joint } = useApp();
  const doc = state.history.present;
  const isAsked = state.ui.exporting.kind === 'film' && doc.frames.length > 0;
  const { width, height } = doc.frames[0] ?? { width: 0, height: 0 };
  useEffect(() => {
    const look = isAsked ? overlayLook(doc, joint.numbers) : null;
    if (!look) return undefined;
    const worker = overlayWorker();
    worker.call('type', { ...look, curves: [] }).then(setType, () => setType(null));
    return () => worker.dispose();
  }, [isAsked, width, height]);
  return type;
}

/** The picture of the frame on view, as the film will have it. */
export function useStill(): (state: State) => Promise<Blob | null> {
  const { joint, services } = useApp();
  const worker = useMemo(() => overlayWorker(), []);
  useEffect(() => () => worker.dispose(), [worker]);
  return async (state) => {
    const look = overlayLook(state.history.present, joint.numbers);
    if (!look) return null;
    const frame = await new OverlayFrames(services).frame(state.ui.frameIndex);
    return await worker.call('still', { look, frame }, { transfer: [frame.picture] });
  };
}
