import { useEffect, useState } from 'preact/hooks';
import { useApp } from '../../commands/app';

/** The whole page is a drop target. Returns whether something is held over it. */
export function useDropTarget(): boolean {
  const { actions } = useApp();
  const [dropping, setDropping] = useState(false);
  useEffect(() => {
    // Entering a child leaves its parent: only the balance of both tells.
    let depth = 0;
    const show = (change: number) => setDropping((depth = Math.max(0, depth + change)) > 0);
    const carriesFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
    const onEnter = (event: DragEvent) => carriesFiles(event) && show(1);
    const onLeave = (event: DragEvent) => carriesFiles(event) && show(-1);
    const onOver = (event: DragEvent) => carriesFiles(event) && event.preventDefault();
    const onDrop = (event: DragEvent) => {
      event.preventDefault();
      show(-depth);
      if (event.dataTransfer) void actions.openDropped(event.dataTransfer);
    };
    const listeners = { dragenter: onEnter, dragleave: onLeave, dragover: onOver, drop: onDrop } as const;
    const entries = Object.entries(listeners) as [string, EventListener][];
    for (const [type, listener] of entries) window.addEventListener(type, listener);
    return () => {
      for (const [type, listener] of entries) window.removeEventListener(type, listener);
    };
  }, [actions]);
  return dropping;
}
