/** CSS pixels. */
const SHORTEST = 60;
const LONGEST = 160;

/** The longest of 1, 2, 5, 10 ... mm that is not too long on the screen; null where that would still be too short. */
export function barLength(pixelsPerMillimetre: number): number | null {
  const most = LONGEST / pixelsPerMillimetre;
  const decade = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((digit) => digit * decade).find((candidate) => candidate <= most);
  return length !== undefined && length * pixelsPerMillimetre >= SHORTEST ? length : null;
}
