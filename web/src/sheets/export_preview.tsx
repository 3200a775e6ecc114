import { useEffect, useRef, useState } from 'preact/hooks';
import { useApp } from '../commands/app';
import { textOf } from '../commands/exporting';
import { USUAL_RATE } from '../commands/overlay_film';
import type { State } from '../document/store';
import { later } from '../texts/later';
import type { FilmType } from '../workers/protocol/overlay';
import { useStill } from './export_film';
import { useLatest } from './latest';

/** How the file will look. */
export function ExportPreview({ state, film }: { state: State; film: FilmType | null | undefined }) {
  const { kind, forms } = state.ui.exporting;
  if (kind === 'session' && forms.session !== 'study') return null;
  if (kind === 'film') return <FilmPreview state={state} isFilm={forms.film === 'video' && film !== null} />;
  return <TextPreview state={state} />;
}

/** So many letters are looked at, of files that may have millions. */
const LETTERS = 6000;

function TextPreview({ state }: { state: State }) {
  const app = useApp();
  const { exporting, frameIndex } = state.ui;
  const { numbers } = app.joint;
  const made = useLatest(() => textOf(app, exporting), [state.history.present, numbers, exporting, frameIndex]);
  const words = later.exporting;
  if (made === null) return <p class="sheet-text quiet">{words.making}</p>;
  if (made.trouble) return <p class="sheet-text" role="alert">{made.trouble}</p>;
  const { value } = made;
  if (!value) return null;
  if (exporting.kind === 'figure') return <Picture of={new Blob([value], { type: 'image/svg+xml' })} key={value} />;
  if (exporting.kind === 'report' || exporting.kind === 'results') return <Page html={value} />;
  return (
    <pre class="export-preview" tabIndex={0} role="region" aria-label={words.preview}>
      {value.length > LETTERS ? `${value.slice(0, LETTERS)}\u2026` : value}
    </pre>
  );
}

function FilmPreview({ state, isFilm }: { state: State; isFilm: boolean }) {
  const app = useApp();
  const still = useStill();
  const doc = state.history.present;
  const made = useLatest(() => still(state), [doc, app.joint.numbers, state.ui.frameIndex, state.ui.seeing.preprocessing]);
  const words = later.exporting;
  return (
    <>
      {isFilm && doc.rate === null && <p class="sheet-text">{words.film.unknownRate(USUAL_RATE)}</p>}
      {made === null && <p class="sheet-text quiet">{words.making}</p>}
      {made?.trouble && <p class="sheet-text" role="alert">{made.trouble}</p>}
      {made?.value && <Picture of={made.value} />}
    </>
  );
}

function Picture({ of }: { of: Blob }) {
  const [address, setAddress] = useState('');
  useEffect(() => {
    const made = URL.createObjectURL(of);
    setAddress(made);
    return () => URL.revokeObjectURL(made);
  }, [of]);
  return <img class="export-picture" alt={later.exporting.preview} src={address} />;
}

/** The report's own style holds in it, and nowhere else; the page's policy allows none inside of what is parsed. */
function Page({ html }: { html: string }) {
  const host = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!host.current) return;
    const [before = '', written = '', after = ''] = html.split(/<\/?style>/);
    const parsed = new DOMParser().parseFromString(before + after, 'text/html');
    const style = new CSSStyleSheet();
    style.replaceSync(written.replaceAll(/:root|body/g, ':host'));
    const root = host.current.shadowRoot ?? host.current.attachShadow({ mode: 'open' });
    root.adoptedStyleSheets = [style];
    root.replaceChildren(...parsed.body.childNodes);
  }, [html]);
  return (
    <div class="export-preview export-page" tabIndex={0} role="region" aria-label={later.exporting.preview}>
      <div ref={host} />
    </div>
  );
}
