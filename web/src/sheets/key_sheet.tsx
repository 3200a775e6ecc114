import { BINDINGS, type Binding } from '../commands/bindings';
import { HAND_BINDINGS, HAND_MOUSE } from '../commands/hand_bindings';
import { SEEING_BINDINGS } from '../commands/seeing_bindings';

const GROUPS = ['Tracing', 'Shaping', 'Mouse', 'Adjusting', 'Seeing', 'Working'] as const;

type Row = Pick<Binding, 'shown' | 'does'>;

function rowsOf(group: (typeof GROUPS)[number]): readonly Row[] {
  if (group === 'Adjusting') return [...HAND_BINDINGS, ...HAND_MOUSE];
  const rows = BINDINGS.filter((binding) => binding.group === group && binding.shown.length > 0);
  return group === 'Seeing' ? [...SEEING_BINDINGS, ...rows] : rows;
}

export function KeySheet() {
  return (
    <div class="key-groups">
      {GROUPS.map((group) => (
        <section key={group} aria-label={group}>
          <h3>{group}</h3>
          <dl>
            {rowsOf(group).map(({ shown, does }) => (
              <div class="key-row" key={does}>
                <dt>
                  {shown.map((keys) => (
                    <kbd key={keys}>{keys}</kbd>
                  ))}
                </dt>
                <dd>{does}</dd>
              </div>
            ))}
          </dl>
        </section>
      ))}
    </div>
  );
}
