import type { FunctionComponent } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { sentenceOf } from '../jobs/services';
import { work } from '../workers/activity';
import { useApp } from './app';

/** What is loaded once it is wanted; null until then. `load` has to stay the same function. */
export function useLater<T>(wanted: boolean, load: () => Promise<T>): T | null {
  const { store } = useApp().services;
  const [loaded, setLoaded] = useState<{ readonly value: T } | null>(null);
  useEffect(() => {
    if (!wanted || loaded) return;
    const over = work.begin();
    load()
      .then((value) => setLoaded({ value }), (error: unknown) => store.say('error', sentenceOf(error)))
      .finally(over);
  }, [wanted, loaded, store, load]);
  return loaded?.value ?? null;
}

/** A view that is loaded when it is first shown. */
export function later<P extends object>(load: () => Promise<FunctionComponent<P>>): FunctionComponent<P> {
  return function Later(props: P) {
    const View = useLater(true, load);
    return View && <View {...props} />;
  };
}
