import { useEffect, useState } from 'preact/hooks';

/** Some of many things in a row, from 0; `last` is the first that is no longer among them. */
export interface Stretch {
  readonly first: number;
  readonly last: number;
}

/** Of so many all are there. */
const ALL = 480;
/** What is in sight is made in steps of so many, and one more on either side. */
const STEP = 60;

/** Which of `count` things of a size are in sight of what scrolls, in whole steps. */
export function stretchInView(offset: number, room: number, size: number, count: number): Stretch {
  if (count <= ALL || size <= 0) return { first: 0, last: count };
  const last = Math.min(count, (Math.ceil((offset + room) / size / STEP) + 1) * STEP);
  const first = Math.max(0, (Math.floor(offset / size / STEP) - 1) * STEP);
  return { first: Math.min(first, last), last };
}

/** How an element lays out what scrolls in it: how far it is scrolled, its room, and the size of one thing, px. */
export type Layout = (element: HTMLElement) => readonly [offset: number, room: number, size: number];

/** The things that are in sight, renewed as somebody scrolls: a long film has thousands, and a screen shows some hundred. `layout` has to stay the same function. */
export function useInView(scroll: { readonly current: HTMLElement | null }, count: number, layout: Layout): Stretch {
  const [stretch, setStretch] = useState<Stretch>({ first: 0, last: Math.min(count, ALL) });
  useEffect(() => {
    const element = scroll.current;
    if (!element) return undefined;
    const look = () => {
      const next = stretchInView(...layout(element), count);
      setStretch((now) => (now.first === next.first && now.last === next.last ? now : next));
    };
    look();
    const observer = new ResizeObserver(look);
    observer.observe(element);
    element.addEventListener('scroll', look, { passive: true });
    return () => {
      observer.disconnect();
      element.removeEventListener('scroll', look);
    };
  }, [scroll, count, layout]);
  // Until they are looked at again.
  return stretch.last > count || (count <= ALL && stretch.last < count) ? { first: 0, last: Math.min(count, ALL) } : stretch;
}
