import { PICTURES } from '../terms/seeing';
import { currentCell, type State } from '../document/store';
import { texts } from '../texts/texts';
import { useApp } from '../commands/app';
import { Edges } from './edges';
import { Landscape } from './landscape';
import { Segments } from '../controls/segments';
import { Space } from './space';
import { Unmatched } from './unmatched';

/** One of three pictures: what fits and what does not, what else might fit, and how it stands in space. */
export function Pictures({ state }: { state: State }) {
  const { store } = useApp().services;
  const { picture } = state.ui.seeing;
  const options = PICTURES.map((value) => ({ value, title: texts.seeing.picture[value] }));
  return (
    <div class="pictures">
      <Segments label={texts.seeing.pictures} options={options} value={picture} onChoose={(chosen) => store.see({ picture: chosen })} />
      {picture === 'unmatched' && (isOfOutline(state) ? <Unmatched state={state} /> : <Edges state={state} />)}
      {picture === 'landscape' && <Landscape state={state} />}
      {picture === 'space' && <Space state={state} />}
    </div>
  );
}

/** A pose from a file, by hand or of the film has no silhouette of its own to be matched. */
function isOfOutline(state: State): boolean {
  const { outline, result } = currentCell(state);
  return result?.kind === 'posed' ? result.from === 'outline' : outline?.closed === true;
}
