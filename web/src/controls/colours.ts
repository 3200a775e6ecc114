import type { ComponentName } from '../terms/component';

/** Okabe and Ito's palette: told apart by colour-blind people. The same everywhere; `theme.css` has them too. */
export const COMPONENT_COLOURS: Readonly<Record<ComponentName, { css: string; light: string; rgb: number }>> = {
  femur: { css: '#56b4e9', light: '#b5defa', rgb: 0x56b4e9 },
  tibia: { css: '#e69f00', light: '#ffd78a', rgb: 0xe69f00 },
};

/** The other set of poses: neither a component's colour nor that of unmatched pixels. */
export const REFERENCE_COLOUR = '#f0e442';
