/** Names that Windows keeps for devices, with any ending. */
const DEVICE = /^(?:aux|con|nul|prn|com[1-9¹²³]|lpt[1-9¹²³])(?:\.|$)/i;

/** Leaves room in the 255 bytes of file systems for what stands beside it, at four bytes a letter. */
const LONGEST = 48;

/**
 * Free text as the beginning of a file's name, on every system and in a zip: letters, digits, `.`, `_` and `-`; no folder,
 * no control or direction mark, no point first, no device, never empty.
 */
export function fileStem(text: string, otherwise = 'study'): string {
  const letters = text.trim().replace(/[^\p{L}\p{N}._-]+/gu, '_');
  const stem = Array.from(letters.replace(/^\.+/, '')).slice(0, LONGEST).join('').replace(/\.+$/, '');
  return DEVICE.test(stem) ? `_${stem}` : stem || otherwise;
}

/** A session with its files and one without: neither is written over the other. */
export function sessionName(work: string, withFiles: boolean): string {
  return `${fileStem(work)}${withFiles ? '' : '_without_files'}.fluoropose.json`;
}
