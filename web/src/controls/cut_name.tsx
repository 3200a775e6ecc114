/** Names are cut before so many last letters: what tells files of a study apart mostly stands there. */
const TAIL = 9;

/** A head of one or two letters would take more room than it has letters for, and look like a word of its own. */
const LEAST_HEAD = 3;

function cutAt(text: string): number {
  return text.length < TAIL + LEAST_HEAD ? 0 : text.length - TAIL;
}

/** A name of a file, cut in its middle where there is no room for it. Whoever stands around it gives the whole of it as a title. */
export function CutName({ text }: { text: string }) {
  return (
    <span class="cut-name">
      <span class="cut-head">{text.slice(0, cutAt(text))}</span>
      <span class="cut-tail">{text.slice(cutAt(text))}</span>
    </span>
  );
}
