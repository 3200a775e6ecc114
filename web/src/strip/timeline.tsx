import { useEffect, useRef } from 'preact/hooks';
import type { State } from '../document/store';
import { COMPONENT_NAMES } from '../terms/component';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { CellRow } from './cell_row';
import { CellSide } from './cell_side';
import { PlayButton } from './play_button';
import { type Layout, useInView } from '../controls/in_view';
import { Icon } from '../controls/icons';

/** More cells than this are as narrow as the whole film wants them, and their signs are bars. */
const MANY = 40;

/** The frames in time, and what is done in each for each component. */
export function Timeline({ state }: { state: State }) {
  const { frames } = state.history.present;
  const scroll = useRef<HTMLDivElement>(null);
  const columns = useInView(scroll, frames.length, columnLayout);
  useEffect(() => showFrame(scroll.current, state.ui.frameIndex, frames.length), [state.ui.frameIndex, frames.length]);
  return (
    <section class={frames.length > MANY ? 'timeline dense' : 'timeline'} aria-label={texts.work.region} style={{ '--count': Math.max(1, frames.length) }}>
      <div class="timeline-scroll" ref={scroll}>
        <div class="timeline-track">
          <FrameSlider state={state} />
          <table class="cells" aria-label={texts.work.cells} aria-colcount={frames.length + 1}>
            <tbody>
              {COMPONENT_NAMES.map((component) => (
                <CellRow key={component} state={state} component={component} columns={columns} />
              ))}
            </tbody>
          </table>
        </div>
      </div>
      <CellSide state={state} />
    </section>
  );
}

function FrameSlider({ state }: { state: State }) {
  const { actions, services } = useApp();
  const { frames, unread } = state.history.present;
  const { frameIndex } = state.ui;
  const last = Math.max(0, frames.length - 1);
  const frame = frames[frameIndex];
  const { work } = texts;
  return (
    <div class="frame-row">
      <div class="frame-steps">
        <button type="button" class="button square" aria-label={work.previousFrame} title={texts.withKey(work.previousFrame, 'D')} disabled={frameIndex <= 0} onClick={() => actions.run({ name: 'previous-frame' })}>
          <Icon name="previous" />
        </button>
        <button type="button" class="button square" aria-label={work.nextFrame} title={texts.withKey(work.nextFrame, 'F')} disabled={frameIndex >= last} onClick={() => actions.run({ name: 'next-frame' })}>
          <Icon name="next" />
        </button>
        <PlayButton state={state} />
        <span class="frame-count">
          {frames.length === 0 ? '–' : frameIndex + 1} / {frames.length}
        </span>
        {unread.length > 0 && (
          <span class="frame-unread" role="img" aria-label={texts.said.withoutUnread(unread)} title={texts.said.withoutUnread(unread)}>
            !
          </span>
        )}
      </div>
      <input
        type="range"
        class="frame-slider"
        aria-label={work.frame}
        aria-valuetext={frame ? work.frameOf(frameIndex + 1, frames.length, frame.name) : work.noFrames}
        min={0}
        max={last}
        step={1}
        value={frameIndex}
        disabled={frames.length < 2}
        onInput={(event) => services.store.goTo(event.currentTarget.valueAsNumber)}
      />
    </div>
  );
}

/** Columns beside what names the rows. */
const columnLayout: Layout = (scroll) => {
  const side = scroll.querySelector<HTMLElement>('.frame-steps')?.offsetWidth ?? 0;
  const columns = Number(scroll.querySelector('.cells')?.getAttribute('aria-colcount')) - 1;
  return [scroll.scrollLeft, scroll.clientWidth - side, (scroll.scrollWidth - side) / Math.max(1, columns)];
};

/** Where there are more frames than fit, the current one is brought into sight, with one beside it. */
function showFrame(scroll: HTMLElement | null, index: number, count: number): void {
  if (!scroll || count === 0 || scroll.scrollWidth <= scroll.clientWidth) return;
  const side = scroll.querySelector<HTMLElement>('.frame-steps')?.offsetWidth ?? 0;
  const width = (scroll.scrollWidth - side) / count;
  const [left, right] = [(index - 1) * width, (index + 2) * width];
  const room = scroll.clientWidth - side;
  if (left < scroll.scrollLeft) scroll.scrollLeft = left;
  else if (right > scroll.scrollLeft + room) scroll.scrollLeft = right - room;
}
