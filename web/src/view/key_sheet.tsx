import { BINDINGS, type Binding } from '../interaction/bindings';

const GROUPS: readonly Binding['group'][] = ['Tracing', 'Shaping', 'Mouse', 'Seeing', 'Working'];

export function KeySheet() {
  return (
    <div class="key-groups">
      {GROUPS.map((group) => (
        <section key={group} aria-label={group}>
          <h3>{group}</h3>
          <dl>
            {BINDINGS.filter((binding) => binding.group === group && binding.shown.length > 0).map(({ shown, does }) => (
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
