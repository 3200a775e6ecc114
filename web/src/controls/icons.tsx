/** Line icons on a 20 x 20 grid, drawn in the text's colour. */
const PATHS = {
  pointer: 'M5 3l10 7-4.6 1L8 16z',
  polygon: 'M4 7l7-4 6 6-4 8-7-2z',
  hand: 'M10 2v16M2 10h16M10 2L7.5 4.5M10 2l2.5 2.5M10 18l-2.5-2.5M10 18l2.5-2.5M2 10l2.500-2.500M2 10l2.500 2.500M18 10l-2.500-2.500M18 10l-2.500 2.500',
  contrast: 'M10 3a7 7 0 110 14a7 7 0 010-14',
  dashed: 'M3 17l2.500-2.500M7.500 12.500l2.500-2.500M12 8l2.500-2.500M16 4l1-1',
  wire: 'M3 15c3-1 3-7 6-8s4 4 8-3M3 15m-1 0a1 1 0 102 0a1 1 0 10-2 0M17 4m-1 0a1 1 0 102 0a1 1 0 10-2 0',
  threshold: 'M3 16h14M5 16V11M8 16V6M11 16V9M14 16V4M3 10h14',
  wand: 'M4 16l7-7M13 3v3M17 7h-3M16 4l-2 2M10 4l1.500 1.500M16 10l-1.500-1.500',
  brush: 'M16 4L9 11M9 11c-2-1-4 0-4 2s-1 3-2 3c3 1.500 7 .5 7-2.500',
  transform: 'M4 6h12v11H4zM10 6V3M3 5h2v2H3zM15 5h2v2h-2zM3 16h2v2H3zM15 16h2v2h-2z',
  stretch: 'M3 13c2-7 5-8 7-8M12 5.500l2 1M15.500 8l1 2.500M17 13v2.500',
  pose: 'M10 2.500l6.500 3.700v7.600L10 17.500l-6.500-3.700V6.200zM10 10v7.500M10 10l6.500-3.800M10 10L3.500 6.200',
  eye: 'M2 10c3-5 13-5 16 0c-3 5-13 5-16 0M10 7.500a2.500 2.500 0 110 5a2.500 2.500 0 010-5',
  lock: 'M5 9h10v8H5zM7 9V6a3 3 0 016 0v3',
  unlocked: 'M5 9h10v8H5zM7 9V6a3 3 0 015.800-1',
  copy: 'M7 7h10v10H7zM13 7V3H3v10h4',
  magnet: 'M4 4v7a6 6 0 0012 0V4h-4v7a2 2 0 01-4 0V4zM4 7h4M12 7h4',
  smooth: 'M3 14l3-8 3 5 3-6 2 7 3-4',
  fit: 'M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4',
  undo: 'M7 4L3 8l4 4M3 8h8a5 5 0 010 10H8',
  redo: 'M13 4l4 4-4 4M17 8H9a5 5 0 000 10h3',
  open: 'M3 6h5l2 2h7v8H3z',
  save: 'M10 3v9M6 9l4 4 4-4M4 16h12',
  previous: 'M12 4l-6 6 6 6',
  next: 'M8 4l6 6-6 6',
  play: 'M6 4l9 6-9 6z',
  pause: 'M7 4v12M13 4v12',
  close: 'M5 5l10 10M15 5L5 15',
  theme: 'M10 6.500a3.500 3.500 0 110 7a3.500 3.500 0 010-7M10 2v2M10 16v2M2 10h2M16 10h2M4.300 4.300l1.400 1.400M14.300 14.300l1.400 1.400M4.300 15.700l1.400-1.400M14.300 5.700l1.400-1.400',
  bin: 'M4 6h12M8 6V4h4v2M6 6l1 11h6l1-11',
} as const;

export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 20 20" width="20" height="20" aria-hidden="true">
      <path d={PATHS[name]} />
      {name === 'contrast' && <path class="solid" d="M10 3a7 7 0 010 14z" />}
    </svg>
  );
}
