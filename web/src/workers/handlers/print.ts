/** Two hashes by multiplication, of 27 and 26 bits. */
const [FIRST, SECOND] = [0x9e3779b1, 0x85ebca77];

/** Tells pictures from each other by their pixels: 53 bits of them. */
export function printOf({ buffer, byteOffset, byteLength }: ArrayBufferView): number {
  const words = new Uint32Array(buffer.slice(byteOffset, byteOffset + byteLength - (byteLength % 4)));
  const rest = new Uint8Array(buffer, byteOffset + 4 * words.length, byteLength % 4);
  let [a, b] = [byteLength, ~byteLength];
  const take = (word: number) => {
    a = Math.imul(a ^ word, FIRST);
    a ^= a >>> 15;
    b = Math.imul(b ^ word, SECOND);
    b ^= b >>> 13;
  };
  words.forEach(take);
  rest.forEach(take);
  return (a >>> 5) * 2 ** 26 + (b >>> 6);
}
