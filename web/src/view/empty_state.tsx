import { useApp } from './app';

export function EmptyState() {
  const { actions } = useApp();
  return (
    <section class="empty" aria-label="Begin">
      <p class="empty-title">Trace an implant on an X-ray; see its pose in space.</p>
      <p class="empty-text">
        Drop frames, models, a calibration, poses, a library or a session anywhere on this page. Nothing leaves this computer.
      </p>
      <div class="empty-buttons">
        <button type="button" class="button primary" onClick={() => void actions.openDemonstration()}>
          Open the demonstration
        </button>
        <button type="button" class="button" onClick={() => void actions.openPicked()}>
          Open files
        </button>
      </div>
    </section>
  );
}
