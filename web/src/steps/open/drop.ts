import { useEffect, useState } from 'preact/hooks';
import { carriesFiles } from '../../exchange/browser_files';

/** Whether something is held over the page, all of which is a drop target. */
export function useDropTarget(): boolean {
  const [dropping, setDropping] = useState(false);
  useEffect(() => {
    // Entering a child leaves its parent: only the balance of both tells.
    let depth = 0;
    const show = (change: number) => setDropping((depth = Math.max(0, depth + change)) > 0);
    const onEnter = (event: DragEvent) => carriesFiles(event) && show(1);
    const onLeave = (event: DragEvent) => carriesFiles(event) && show(-1);
    const listeners = { dragenter: onEnter, dragleave: onLeave, drop: () => show(-depth) } as const;
    const entries = Object.entries(listeners) as [string, EventListener][];
    for (const [type, listener] of entries) window.addEventListener(type, listener);
    return () => {
      for (const [type, listener] of entries) window.removeEventListener(type, listener);
    };
  }, []);
  return dropping;
}
