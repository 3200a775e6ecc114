import { useApp } from '../../commands/app';
import type { State } from '../../document/store';
import { DOCK } from '../../terms/joint';
import { later } from '../../texts/later';

/** The dock's upper border: drawn by the mouse, or moved by arrows. */
export function DockSize({ state }: { state: State }) {
  const { store } = useApp().services;
  const { height } = state.ui.joint;
  const set = (wanted: number) => store.setJoint({ height: Math.min(DOCK.large, Math.max(DOCK.least, wanted)) });
  const onKey = (event: KeyboardEvent) => {
    const step = { ArrowUp: DOCK.step, ArrowDown: -DOCK.step }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    set(height + step);
  };
  // The status line stands below.
  const onMove = (event: PointerEvent & { currentTarget: HTMLElement }) => {
    const dock = event.currentTarget.closest('.joint');
    if (event.currentTarget.hasPointerCapture(event.pointerId) && dock) set((dock.getBoundingClientRect().bottom - event.clientY) / innerHeight);
  };
  return (
    <div
      class="joint-size"
      role="separator"
      aria-orientation="horizontal"
      aria-label={later.curves.size}
      aria-valuenow={Math.round(100 * height)}
      aria-valuemin={100 * DOCK.least}
      aria-valuemax={100 * DOCK.large}
      tabIndex={0}
      onKeyDown={onKey}
      onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
      onPointerMove={onMove}
    />
  );
}
