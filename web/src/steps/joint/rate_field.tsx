import { useApp } from '../../commands/app';
import { NumberField } from '../../controls/number_field';
import * as commands from '../../document/commands';
import type { Doc } from '../../document/types';
import { later } from '../../texts/later';

/** How many frames there are in a second: part of the study, like the side of the body. */
export function RateField({ doc }: { doc: Doc }) {
  const { store } = useApp().services;
  const set = (value: number) => store.perform(commands.setRate(value > 0 ? value : null));
  return <NumberField label={later.curves.rate} unit="1/s" value={doc.rate ?? NaN} onChange={set} />;
}
