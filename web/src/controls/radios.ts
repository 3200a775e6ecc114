/** A key in a radio group, as in any: arrows choose the neighbour, round and round; Home and End the first and the last. */
export function byArrows(event: KeyboardEvent): void {
  const group = event.currentTarget;
  if (!(group instanceof HTMLElement) || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey) return;
  const radios = [...group.querySelectorAll<HTMLElement>('[role="radio"]')];
  const next = radios[nextIndex(event.key, radios.findIndex((radio) => radio === event.target), radios.length)];
  if (!next) return;
  // Elsewhere arrows go through the film.
  event.preventDefault();
  event.stopPropagation();
  next.focus();
  next.click();
}

/** -1 for a key that chooses nothing. */
export function nextIndex(key: string, from: number, count: number): number {
  if (from < 0) return -1;
  if (key === 'Home') return 0;
  if (key === 'End') return count - 1;
  if (key === 'ArrowRight' || key === 'ArrowDown') return (from + 1) % count;
  if (key === 'ArrowLeft' || key === 'ArrowUp') return (from + count - 1) % count;
  return -1;
}
