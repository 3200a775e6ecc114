import { useState } from 'preact/hooks';
import type { PoseSets, State } from '../../document/store';
import { COMPONENT_NAMES, type ComponentName } from '../../terms/component';
import { texts } from '../../texts/texts';
import { useApp } from '../../commands/app';

type Chosen = Readonly<Record<ComponentName, number | null>>;

/** Which of several files of poses is used for each component. */
export function SetsSheet({ state }: { state: State }) {
  const { poseSets } = state.ui;
  return poseSets ? <Choice sets={poseSets} /> : <p class="sheet-body sheet-text">{texts.files.sets.none}</p>;
}

function Choice({ sets }: { sets: PoseSets }) {
  const { store } = useApp().services;
  const [chosen, setChosen] = useState<Chosen>({ femur: 0, tibia: 0 });
  const words = texts.files.sets;
  const contested = COMPONENT_NAMES.filter((component) => sets.names[component].length > 0);
  return (
    <form
      class="sheet-body"
      onSubmit={(event) => {
        event.preventDefault();
        store.show({ poseSets: null, popover: null });
        sets.take(chosen);
      }}
    >
      <p class="sheet-text">{words.meaning}</p>
      {contested.map((component) => (
        <fieldset key={component} class="choices">
          <legend>{words.of(texts.component[component])}</legend>
          {[...sets.names[component], null].map((name, index) => {
            const value = name === null ? null : index;
            return (
              <label key={name} class="check">
                <input type="radio" name={component} checked={chosen[component] === value} onChange={() => setChosen({ ...chosen, [component]: value })} />
                {name ?? words.leaveOut}
              </label>
            );
          })}
        </fieldset>
      ))}
      <div class="sheet-buttons">
        <button type="submit" class="button primary">
          {words.use}
        </button>
      </div>
    </form>
  );
}
