import type { RefObject } from 'preact';
import { useLayoutEffect } from 'preact/hooks';

/** While it is wanted, an element has half of the stage's room, beside the frame and as large. */
export function useBesideFrame(element: RefObject<HTMLElement>, wanted: boolean): void {
  useLayoutEffect(() => {
    const stage = document.querySelector('.stage');
    const host = element.current;
    if (!wanted || !stage || !host) return undefined;
    const { classList } = document.documentElement;
    classList.add('beside');
    const place = () => {
      const { right, top, width, height } = stage.getBoundingClientRect();
      Object.assign(host.style, { left: `${right}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
    };
    place();
    const watcher = new ResizeObserver(place);
    watcher.observe(stage);
    return () => {
      watcher.disconnect();
      classList.remove('beside');
      host.removeAttribute('style');
    };
  }, [wanted]);
}
