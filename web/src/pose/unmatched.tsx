import { useEffect, useRef } from 'preact/hooks';
import { currentCell, type State } from '../document/store';
import type { Findings } from '../jobs/poser';
import { useApp } from '../commands/app';
import { texts } from '../texts/texts';

const SIZE = 256;

function described({ clipped, partial, milliseconds }: Findings): string {
  const { unmatched } = texts.panel;
  return partial ? unmatched.partial : clipped ? unmatched.clipped : unmatched.found(milliseconds.toFixed(0));
}

/** Both canonical silhouettes in one frame, black where they differ: the figure of Walker et al. 1996. */
export function Unmatched({ state }: { state: State }) {
  const { poser, services } = useApp();
  const canvas = useRef<HTMLCanvasElement>(null);
  const { outline, result } = currentCell(state);
  // A pose from a file has no match of its own to show.
  const matched = result?.kind === 'posed' && result.from === 'outline';
  const findings = matched ? poser.findings(outline) : null;
  const candidate = matched ? result.candidates[result.chosen] : undefined;
  const picture = (candidate && poser.detail(outline, candidate)?.picture) ?? null;
  useEffect(() => {
    const context = canvas.current?.getContext('2d');
    if (!context) return;
    if (picture) services.studio.paintUnmatched(context, picture);
    else context.clearRect(0, 0, SIZE, SIZE);
  }, [picture, services]);
  return (
    <section class="card unmatched" aria-label={texts.panel.unmatched.region}>
      <canvas
        ref={canvas}
        width={picture?.size ?? SIZE}
        height={picture?.size ?? SIZE}
        role="img"
        aria-label={picture ? texts.panel.unmatched.picture : texts.panel.unmatched.working}
      />
      <p class="card-note">
        <span class="key-swatch" aria-hidden="true" /> {texts.panel.unmatched.differs}
        <span class="timing">{findings && findings.details.length > 0 ? described(findings) : ''}</span>
      </p>
    </section>
  );
}
