import { useEffect, useRef, useState } from 'preact/hooks';
import type { State } from '../../document/store';
import { timesOf } from '../../exchange/video';
import { texts } from '../../texts/texts';
import { useApp } from '../../commands/app';
import { NumberField } from '../../controls/number_field';

const said = texts.files.video;

/** Which pictures of a video become frames. */
export function VideoSheet({ state }: { state: State }) {
  const { videos } = useApp();
  const picture = useRef<HTMLCanvasElement>(null);
  const { video } = videos;
  const [choice, setChoice] = useState({ from: 0, to: video?.duration ?? 0, every: 1 });
  useEffect(() => {
    if (video && picture.current) void videos.show(choice.from, picture.current);
  }, [videos, video, choice.from]);
  if (!video) return <p class="sheet-body">{said.none}</p>;
  const count = timesOf(video, choice).length;
  const busy = state.ui.jobs.some(({ title }) => title === said.taking);
  const set = (field: keyof typeof choice) => (value: number) => setChoice({ ...choice, [field]: value });
  return (
    <form
      class="sheet-body"
      onSubmit={(event) => {
        event.preventDefault();
        void videos.take(choice);
      }}
    >
      <p class="sheet-text">{said.facts(video.name, video.width, video.height, video.duration.toFixed(2), video.rate.toFixed(2))}</p>
      <canvas ref={picture} class="video-picture" width={video.width} height={video.height} role="img" aria-label={said.picture(choice.from.toFixed(3))} />
      <div class="fields">
        <NumberField label={said.from} unit="s" value={choice.from} onChange={set('from')} />
        <NumberField label={said.to} unit="s" value={rounded(choice.to)} onChange={set('to')} />
        <NumberField label={said.every} unit={said.everyUnit} value={choice.every} onChange={set('every')} />
      </div>
      <p class="sheet-text quiet">{said.compressed}</p>
      <div class="sheet-buttons">
        <button type="submit" class="button primary" disabled={count === 0 || busy}>
          {said.take}
        </button>
        <span class="sheet-text">{count === 0 ? said.none : said.count(count)}</span>
      </div>
    </form>
  );
}

function rounded(value: number): number {
  return Math.round(1000 * value) / 1000;
}
