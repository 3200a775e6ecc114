/** How the tools work; set in the strip above the frame, kept while the page is open. */
export interface TracingOptions {
  /** Metal is brighter than what surrounds it; null until a click or a person tells it. */
  readonly bright: boolean | null;
  /** Of the brush, frame pixels. */
  readonly radius: number;
  readonly erase: boolean;
  /** Grey value of the threshold; null: what suits the place that is pointed at. */
  readonly level: number | null;
  /** The threshold cuts bridges up to twice this thick, px. */
  readonly bridge: number;
  /** The live-wire fixes what has stayed the same for a while. */
  readonly cooling: boolean;
  /** How far snapping looks for an edge, px. */
  readonly reach: number;
}

export const USUAL_OPTIONS: TracingOptions = {
  bright: null,
  radius: 8,
  erase: false,
  level: null,
  bridge: 2,
  cooling: true,
  reach: 6,
};

export const RADIUS = { least: 1, most: 60 } as const;
