import type { State } from '../document/store';
import { texts } from '../texts/texts';

/** Everything that was said, the latest first. */
export function LogSheet({ state }: { state: State }) {
  const { log } = state.ui;
  if (log.length === 0) return <p class="sheet-body sheet-text">{texts.log.empty}</p>;
  return (
    <ol class="sheet-body log">
      {log.toReversed().map(({ kind, text, at }, index) => (
        <li key={log.length - index} class={kind}>
          <time>{new Date(at).toLocaleTimeString()}</time> {text}
        </li>
      ))}
    </ol>
  );
}
