import type { FunctionComponent } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { useApp } from '../../commands/app';
import type { State } from '../../document/store';
import { sentenceOf } from '../../jobs/services';
import { work } from '../../workers/activity';

/** The card of the check, loaded with the first doubtful pose that somebody looks at. */
export function CheckLater({ state }: { state: State }) {
  const { store } = useApp().services;
  const [Card, setCard] = useState<FunctionComponent<{ state: State }> | null>(null);
  const { checking } = state.ui;
  useEffect(() => {
    if (!checking || Card) return;
    const over = work.begin();
    import('./check_card')
      .then(({ CheckCard }) => setCard(() => CheckCard), (error: unknown) => store.say('error', sentenceOf(error)))
      .finally(over);
  }, [checking, Card, store]);
  return Card && checking ? <Card state={state} /> : null;
}
