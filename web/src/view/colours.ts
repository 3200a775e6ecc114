import type { ComponentName } from '../document/types';

/** Okabe and Ito's palette: told apart by colour-blind people. The same everywhere; `theme.css` has them too. */
export const COMPONENT_COLOURS: Readonly<Record<ComponentName, { css: string; rgb: number }>> = {
  femur: { css: '#56b4e9', rgb: 0x56b4e9 },
  tibia: { css: '#e69f00', rgb: 0xe69f00 },
};
