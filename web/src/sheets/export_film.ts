import { useEffect, useMemo, useState } from 'preact/hooks';
import { useApp } from '../commands/app';
import { overlayLook, OverlayPictures } from '../commands/overlay_film';
import type { State } from '../document/store';
import type { FilmType } from '../workers/protocol/overlay';

/** What kind of film this browser writes of these frames; null where none, undefined while it is asked. */
export function useFilmType(state: State): FilmType | null | undefined {
  const [type, setType] = useState<FilmType | null | undefined>(undefined);
  const { joint, services } = useApp();
  const doc = state.history.present;
  const isAsked = state.ui.exporting.kind === 'film' && doc.frames.length > 0;
  const { width, height } = doc.frames[0] ?? { width: 0, height: 0 };
  useEffect(() => {
    const look = isAsked ? overlayLook(doc, joint.numbers) : null;
    if (!look) return undefined;
    const pictures = new OverlayPictures(services);
    pictures.type(look).then(setType, () => setType(null));
    return () => pictures.dispose();
  }, [isAsked, width, height]);
  return type;
}

/** The picture of the frame on view, as the film will have it. */
export function useStill(): (state: State) => Promise<Blob | null> {
  const { joint, services } = useApp();
  const pictures = useMemo(() => new OverlayPictures(services), [services]);
  useEffect(() => () => pictures.dispose(), [pictures]);
  return async (state) => {
    const look = overlayLook(state.history.present, joint.numbers);
    return look && (await pictures.still(look, state.ui.frameIndex));
  };
}
